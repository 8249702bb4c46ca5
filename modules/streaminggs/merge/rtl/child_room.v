// Keys for which there is room in a node and below it, by its place in its level.
module child_room #(
    parameter ENTRIES = 512,
    parameter LEVEL = 1,  // of the node, the root's is 0
    parameter LEVELS = 9,
    parameter ROOM_BITS = 8
) (
    input [LEVEL-1:0] place,
    output [ROOM_BITS-1:0] room
);
  localparam ABOVE_LAST = 2 * ((1 << (LEVELS - 1 - LEVEL)) - 1);  // keys below it in whole levels
  localparam [31:0] LAST = 2 << (LEVELS - 1 - LEVEL);             // and at most in the last one
  localparam [31:0] LAST_KEYS = ENTRIES - 2 * ((1 << (LEVELS - 1)) - 1);  // of all nodes there

  wire [31:0] ahead = {{(32 - LEVEL) {1'b0}}, place} * LAST;
  wire [31:0] left = ahead > LAST_KEYS ? 0 : LAST_KEYS - ahead;
  wire [31:0] all = ABOVE_LAST + (left > LAST ? LAST : left);
  assign room = all[ROOM_BITS-1:0];
  wire unused = &{1'b0, all[31:ROOM_BITS]};
endmodule
