// A level of the heap below the root, beside its memory: the operation that is at this level, for a cycle.
// Another one is at least two levels away.
//   insert  its node was read as it came here
//   delete  its node and the other child were read two cycles ago and compared one cycle ago; their
//           children have been read since
// The level is written in the cycle in which an operation is here. One that is two levels behind may read
// that node in the same cycle: a register has it for the next two.
module heap_level #(
    parameter LEVEL = 3,  // the root's is 0
    parameter LEVELS = 9,
    parameter ENTRIES = 512,
    parameter KEY_BITS = 256,
    parameter COMPARED_BITS = 64,
    parameter COUNT_BITS = LEVELS - LEVEL,                 // in the last level there are no counts
    parameter WIDTH = 2 * (KEY_BITS + (LEVEL < LEVELS - 1 ? COUNT_BITS : 0)),
    parameter ABOVE_BITS = LEVEL > 1 ? LEVEL - 1 : 1,      // of a place at the level above
    parameter ADDRESS_BITS = LEVEL > 2 ? LEVEL - 2 : 1     // of a bank
) (
    input clock,
    input reset,
    // The operation at the level above.
    input comes,  // goes on to this level
    input inserts,
    input at_high,
    input [ABOVE_BITS-1:0] at_above,
    input side,
    input [COUNT_BITS:0] held,
    input [KEY_BITS-1:0] key,
    // A delete two levels above reads below both children of its node.
    input [3:0] reads_ahead,
    input [ADDRESS_BITS-1:0] ahead_at,
    // For the level above: the children of its node, and which of their children hold keys.
    output [2*KEY_BITS-1:0] left,
    output [2*KEY_BITS-1:0] right,
    output [3:0] has_keys,
    // The same of the level below.
    input [2*KEY_BITS-1:0] left_child,
    input [2*KEY_BITS-1:0] right_child,
    input [3:0] has_keys_below,
    // The operation at this level.
    output goes_on,
    output inserts_here,
    output at_high_here,
    output [LEVEL-1:0] at_here,
    output side_below,
    output [COUNT_BITS-1:0] held_below,
    output [KEY_BITS-1:0] sinking,
    output [3:0] asks_ahead,  // two levels below
    // The memory, a bit a bank.
    output [3:0] reads,
    output [ADDRESS_BITS-1:0] read_at,
    input [4*WIDTH-1:0] read,
    output [3:0] writes,
    output [ADDRESS_BITS-1:0] write_at,
    output [WIDTH-1:0] written
);
  reg is_here, is_insert, is_high;
  reg [LEVEL-1:0] place;
  reg [COUNT_BITS:0] holds;
  reg [KEY_BITS-1:0] sinks;
  reg [WIDTH-1:0] last_written;
  reg [3:0] passes_by;
  wire [ABOVE_BITS:0] at = {at_above, side};
  wire changes;
  always @(posedge clock) begin
    is_here <= comes & ~reset;
    if (comes) begin
      is_insert <= inserts;
      is_high <= at_high;
      place <= at[LEVEL-1:0];
      holds <= held;
    end
    if (comes & inserts) sinks <= key;
    if (is_here & changes) last_written <= written;
  end

  // The memory. The two lowest bits of a place say which bank.
  wire [ABOVE_BITS+2:0] coming = {2'b0, at};
  wire [LEVEL+1:0] here = {2'b0, place};
  wire pair_above = LEVEL > 1 & at_above[0];
  wire [1:0] coming_bank = {pair_above, side}, bank = {LEVEL > 1 & here[1], here[0]};
  wire reads_node = comes & inserts & held != 0;
  assign reads = reads_ahead | {3'b0, reads_node} << coming_bank;
  assign read_at = reads_node ? coming[2+:ADDRESS_BITS] : ahead_at;
  assign writes = {3'b0, is_here & changes} << bank;
  assign write_at = here[2+:ADDRESS_BITS];
  wire [4*WIDTH-1:0] found;
  genvar b;
  generate
    for (b = 0; b < 4; b = b + 1) begin : banks
      always @(posedge clock) if (reads[b]) passes_by[b] <= writes[b] & read_at == write_at;
      assign found[b*WIDTH+:WIDTH] = passes_by[b] ? last_written : read[b*WIDTH+:WIDTH];
    end
  endgenerate

  // Two siblings: the operation's node and another one, or the children of a node at the level above.
  wire second_pair = is_here ? bank[1] : pair_above;
  wire [WIDTH-1:0] left_node = second_pair ? found[2*WIDTH+:WIDTH] : found[0+:WIDTH];
  wire [WIDTH-1:0] right_node = second_pair ? found[3*WIDTH+:WIDTH] : found[WIDTH+:WIDTH];
  wire [WIDTH-1:0] node = bank[0] ? right_node : left_node;
  assign left = left_node[2*KEY_BITS-1:0];
  assign right = right_node[2*KEY_BITS-1:0];

  // The operation.
  wire [COUNT_BITS-1:0] below_left, below_right, new_below_left, new_below_right, left_room, right_room;
  wire [KEY_BITS-1:0] new_low, new_high;
  generate
    if (LEVEL < LEVELS - 1) begin : counts
      assign {below_right, below_left} = node[2*KEY_BITS+:2*COUNT_BITS];
      assign written = {new_below_right, new_below_left, new_high, new_low};
      for (b = 0; b < 2; b = b + 1) begin : children
        assign has_keys[b] = left_node[2*KEY_BITS+b*COUNT_BITS+:COUNT_BITS] != 0;
        assign has_keys[2+b] = right_node[2*KEY_BITS+b*COUNT_BITS+:COUNT_BITS] != 0;
      end
      child_room #(
          .ENTRIES(ENTRIES),
          .LEVEL(LEVEL + 1),
          .LEVELS(LEVELS),
          .ROOM_BITS(COUNT_BITS)
      ) of_left (
          .place({place, 1'b0}),
          .room(left_room)
      );
      child_room #(
          .ENTRIES(ENTRIES),
          .LEVEL(LEVEL + 1),
          .LEVELS(LEVELS),
          .ROOM_BITS(COUNT_BITS)
      ) of_right (
          .place({place, 1'b1}),
          .room(right_room)
      );
    end else begin : no_counts
      assign {below_right, below_left, right_room, left_room} = 0;
      assign has_keys = 0;
      assign written = {new_high, new_low};
    end
  endgenerate
  wire passes;
  heap_node #(
      .KEY_BITS(KEY_BITS),
      .COMPARED_BITS(COMPARED_BITS),
      .COUNT_BITS(COUNT_BITS)
  ) operation (
      .inserts(is_insert),
      .at_high(is_high),
      .held(holds),
      .key(sinks),
      .low(node[KEY_BITS-1:0]),
      .high(node[2*KEY_BITS-1:KEY_BITS]),
      .below_left(below_left),
      .below_right(below_right),
      .left_room(left_room),
      .right_room(right_room),
      .left(left_child),
      .right(right_child),
      .writes(changes),
      .new_low(new_low),
      .new_high(new_high),
      .new_below_left(new_below_left),
      .new_below_right(new_below_right),
      .goes_on(passes),
      .side(side_below),
      .held_below(held_below),
      .sinking(sinking)
  );
  wire unused = &{1'b0, coming, here, new_below_left, new_below_right};
  assign goes_on = is_here & passes;
  assign inserts_here = is_insert;
  assign at_high_here = is_high;
  assign at_here = place;
  ahead_reads #(
      .COUNT_BITS(COUNT_BITS)
  ) ahead (
      .deletes(goes_on & ~is_insert),
      .below_left(below_left),
      .below_right(below_right),
      .has_keys(has_keys_below),
      .reads(asks_ahead)
  );
endmodule
