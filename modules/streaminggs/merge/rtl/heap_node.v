// What an operation makes of a node and what goes on to the level below (algorithm/order/interval_heap.h).
// An insert gives its key the place that it takes in the node's interval; what it displaces goes on. A
// delete fills its hole from a child, and a hole goes on. Two pairs of keys are compared.
module heap_node #(
    parameter KEY_BITS = 256,
    parameter COMPARED_BITS = 64,  // of a key, in front
    parameter COUNT_BITS = 9       // of the keys at and below a child
) (
    input inserts,  // or deletes
    input at_high,  // the end that is deleted
    input [COUNT_BITS:0] held,  // keys at and below the node, so far
    input [KEY_BITS-1:0] key,   // that is inserted
    input [KEY_BITS-1:0] low,
    input [KEY_BITS-1:0] high,
    input [COUNT_BITS-1:0] below_left,
    input [COUNT_BITS-1:0] below_right,
    input [COUNT_BITS-1:0] left_room,
    input [COUNT_BITS-1:0] right_room,
    input [2*KEY_BITS-1:0] left,  // a child's high key, its low key
    input [2*KEY_BITS-1:0] right,
    output writes,  // the node changes
    output [KEY_BITS-1:0] new_low,
    output [KEY_BITS-1:0] new_high,
    output [COUNT_BITS-1:0] new_below_left,
    output [COUNT_BITS-1:0] new_below_right,
    output goes_on,
    output side,  // 1: to the right child
    output [COUNT_BITS-1:0] held_below,
    output [KEY_BITS-1:0] sinking
);
  localparam REST = KEY_BITS - COMPARED_BITS;
  localparam [COUNT_BITS:0] TWO = 2;
  localparam [COUNT_BITS-1:0] ONE = 1;

  // The keys that may fill the hole; a key alone is the low one.
  wire from_left_high = at_high & below_left >> 1 != 0;
  wire from_right_high = at_high & below_right >> 1 != 0;
  wire [KEY_BITS-1:0] left_end = from_left_high ? left[2*KEY_BITS-1:KEY_BITS] : left[KEY_BITS-1:0];
  wire [KEY_BITS-1:0] right_end = from_right_high ? right[2*KEY_BITS-1:KEY_BITS] : right[KEY_BITS-1:0];

  wire [COMPARED_BITS-1:0] nearer = inserts ? key[KEY_BITS-1:REST] :
      at_high ? left_end[KEY_BITS-1:REST] : right_end[KEY_BITS-1:REST];
  wire [COMPARED_BITS-1:0] farther = inserts ? low[KEY_BITS-1:REST] :
      at_high ? right_end[KEY_BITS-1:REST] : left_end[KEY_BITS-1:REST];
  wire is_nearer = nearer < farther;
  wire is_farther = high[KEY_BITS-1:REST] < key[KEY_BITS-1:REST];

  // The emptier child that has room, or the one whose key fills the hole.
  wire left_has = below_left < left_room, right_has = below_right < right_room;
  wire with_room = right_has & (~left_has | below_right < below_left);
  wire filling = below_left == 0 | (below_right != 0 & is_nearer);
  assign side = inserts ? with_room : filling;
  assign goes_on = inserts ? held >= TWO : held > TWO;
  assign held_below = side ? below_right : below_left;
  wire is_first = held == 0, is_second = held == 1;
  assign writes = inserts | goes_on | (held == TWO & ~at_high);

  // The key that comes, inserted or into the hole; with no key below, the high one to the low end.
  wire [KEY_BITS-1:0] coming = inserts ? key : ~goes_on ? high : side ? right_end : left_end;
  wire takes_low = inserts ? is_first | is_nearer : ~at_high | ~goes_on;
  assign new_low = takes_low ? coming : low;
  // An insert's key or what it displaced goes to the high end or on.
  wire [KEY_BITS-1:0] displaced = inserts & is_nearer ? low : coming;
  wire takes_high = inserts ? is_second | is_farther : at_high & goes_on;
  assign new_high = takes_high ? displaced : high;
  assign sinking = is_farther ? high : displaced;

  wire [COUNT_BITS-1:0] changed = inserts ? held_below + ONE : held_below - ONE;
  wire empties = inserts & is_first;
  assign new_below_left = empties ? 0 : goes_on & ~side ? changed : below_left;
  assign new_below_right = empties ? 0 : goes_on & side ? changed : below_right;
endmodule
