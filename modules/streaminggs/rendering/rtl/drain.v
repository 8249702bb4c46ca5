// Which pixels of a group are read in draining: row by row, eight a cycle, of two sub-tiles beside each
// other. They are there a cycle later; behind its last row a sub-tile is cleared in that cycle.
module drain (
    input clock,
    input reset,
    input begins,            // in the next cycle
    input [9:0] width,       // of the group, px
    input [9:0] height,
    output reg [9:0] x,      // the first pixel that is read
    output reg [9:0] y,
    output reg reads,
    output reg [9:0] read_x,  // the first pixel that is there
    output reg [9:0] read_y,
    output reg has_read,
    output clears,
    output ends              // in this cycle
);
  localparam [9:0] PIXELS = 8;

  wire row_ends = x + PIXELS >= width;
  wire is_last = row_ends & y + 10'd1 == height;
  always @(posedge clock) begin
    reads <= ~reset & (begins | (reads & ~is_last));
    x <= begins | row_ends ? 10'd0 : x + PIXELS;
    y <= begins ? 10'd0 : row_ends ? y + 10'd1 : y;
    has_read <= ~reset & reads;
    read_x <= x;
    read_y <= y;
  end
  assign clears = has_read & (read_y[1:0] == 2'd3 | read_y + 10'd1 == height);
  assign ends = has_read & ~reads;
endmodule
