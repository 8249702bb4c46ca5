// The bitonic network of 16 keys (Batcher, "Sorting networks and their applications", 1968), with the
// places that keys came from. A key is compared as a whole number: whether it is missing, depth without
// its sign, slot. A block of 16 enters every cycle and leaves in order 10 cycles later. A merge enters
// ahead of the last four stages: two runs of 8 in order become 16.
module sorting_network #(
    parameter KEY_BITS = 64,
    parameter PLACE_BITS = 8,
    parameter MERGES = 1  // 0: it sorts blocks alone
) (
    input clock,
    input [16*KEY_BITS-1:0] keys,
    input [16*PLACE_BITS-1:0] places,
    input merges,  // takes the place of a block that entered six cycles earlier
    input [16*KEY_BITS-1:0] runs,
    input [16*PLACE_BITS-1:0] run_places,
    output [16*KEY_BITS-1:0] sorted,
    output [16*PLACE_BITS-1:0] sorted_places
);
  localparam STAGES = 10, BEFORE_MERGE = 6;
  localparam ALL_KEYS = 16 * KEY_BITS, ALL_PLACES = 16 * PLACE_BITS;
  // Ahead of each stage.
  wire [(STAGES+1)*ALL_KEYS-1:0] k;
  wire [(STAGES+1)*ALL_PLACES-1:0] p;
  assign k[0+:ALL_KEYS] = keys;
  assign p[0+:ALL_PLACES] = places;
  genvar run, step;
  generate
    for (run = 1; run <= 4; run = run + 1) begin : sorts  // runs of 2^run keys
      for (step = 0; step < run; step = step + 1) begin : stages
        localparam S = run * (run - 1) / 2 + step;
        wire [ALL_KEYS-1:0] entering =
            MERGES != 0 && S == BEFORE_MERGE && merges ? runs : k[S*ALL_KEYS+:ALL_KEYS];
        wire [ALL_PLACES-1:0] entering_places =
            MERGES != 0 && S == BEFORE_MERGE && merges ? run_places : p[S*ALL_PLACES+:ALL_PLACES];
        exchange_stage #(
            .KEY_BITS(KEY_BITS),
            .PLACE_BITS(PLACE_BITS),
            .MIRRORED(step == 0 ? 1 : 0),
            .DISTANCE(1 << (run - 1 - step))
        ) stage (
            .clock(clock),
            .keys(entering),
            .places(entering_places),
            .next_keys(k[(S+1)*ALL_KEYS+:ALL_KEYS]),
            .next_places(p[(S+1)*ALL_PLACES+:ALL_PLACES])
        );
      end
    end
  endgenerate
  assign sorted = k[STAGES*ALL_KEYS+:ALL_KEYS];
  assign sorted_places = p[STAGES*ALL_PLACES+:ALL_PLACES];
endmodule
