// Hands out a row of a splat's sub-tiles: each cluster's queue takes the first of its own of what is left
// and not finished, one a cycle. The row stays until nothing is left of it.
module dispatcher #(
    parameter COLUMNS = 24,
    parameter CLUSTERS = 4,  // a power of 2
    parameter CLUSTER_BITS = $clog2(CLUSTERS)
) (
    input clock,
    input reset,
    input holds,                     // there is a row
    input [7:0] first,               // its sub-tiles
    input [7:0] past,
    input [CLUSTER_BITS-1:0] shift,  // the cluster of its first column
    input [COLUMNS-1:0] finished,
    input [CLUSTERS-1:0] has_room,
    output row_ends,
    output reg [CLUSTERS-1:0] pushes,
    output reg [CLUSTERS*8-1:0] columns
);
  reg is_held;  // the row was handed out in part
  reg [COLUMNS-1:0] rest;

  reg [COLUMNS-1:0] span, left, own, taken;
  reg [CLUSTER_BITS-1:0] cluster;
  integer x, k;
  always @* begin
    for (x = 0; x < COLUMNS; x = x + 1) span[x] = x >= {24'b0, first} & x < {24'b0, past};
    left = (is_held ? rest : span) & ~finished;
    taken = 0;
    pushes = 0;
    columns = 0;
    own = 0;
    cluster = 0;
    for (k = 0; k < CLUSTERS; k = k + 1) begin
      for (x = 0; x < COLUMNS; x = x + 1) begin
        cluster = x[CLUSTER_BITS-1:0] + shift;
        own[x] = left[x] & cluster == k[CLUSTER_BITS-1:0];
      end
      own = own & -own;
      for (x = 0; x < COLUMNS; x = x + 1) if (own[x]) columns[k*8+:8] = x[7:0];
      pushes[k] = holds & has_room[k] & own != 0;
      if (has_room[k]) taken = taken | own;
    end
  end
  assign row_ends = holds & (left & ~taken) == 0;
  always @(posedge clock) begin
    if (holds) rest <= left & ~taken;
    is_held <= ~reset & holds & ~row_ends;
  end
endmodule
