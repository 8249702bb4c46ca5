// A stage of the network: 8 compare-exchanges. The first stage of a run's sorting compares keys from both
// ends of the run, the others keys that are `DISTANCE` apart, so that each hands on the nearer key at the
// lower index.
module exchange_stage #(
    parameter KEY_BITS = 64,
    parameter PLACE_BITS = 8,
    parameter MIRRORED = 0,  // runs of 2 DISTANCE keys, from both ends
    parameter DISTANCE = 1
) (
    input clock,
    input [16*KEY_BITS-1:0] keys,
    input [16*PLACE_BITS-1:0] places,
    output [16*KEY_BITS-1:0] next_keys,
    output [16*PLACE_BITS-1:0] next_places
);
  genvar e;
  generate
    for (e = 0; e < 8; e = e + 1) begin : exchanges
      localparam I = e / DISTANCE * 2 * DISTANCE + e % DISTANCE;
      localparam J = MIRRORED != 0 ? I + 2 * (DISTANCE - e % DISTANCE) - 1 : I + DISTANCE;
      compare_exchange #(
          .KEY_BITS(KEY_BITS),
          .PLACE_BITS(PLACE_BITS)
      ) exchange (
          .clock(clock),
          .a(keys[I*KEY_BITS+:KEY_BITS]),
          .b(keys[J*KEY_BITS+:KEY_BITS]),
          .a_place(places[I*PLACE_BITS+:PLACE_BITS]),
          .b_place(places[J*PLACE_BITS+:PLACE_BITS]),
          .nearer(next_keys[I*KEY_BITS+:KEY_BITS]),
          .farther(next_keys[J*KEY_BITS+:KEY_BITS]),
          .nearer_place(next_places[I*PLACE_BITS+:PLACE_BITS]),
          .farther_place(next_places[J*PLACE_BITS+:PLACE_BITS])
      );
    end
  endgenerate
endmodule
