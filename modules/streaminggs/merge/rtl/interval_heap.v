// An interval heap whose every operation goes from the root down, a level a cycle
// (algorithm/order/interval_heap.h), with the root in registers. An operation begins every second cycle at
// most. In that cycle a delete's key is there, as `nearest` or `farthest`; its effect is seen from the next
// one on.
module interval_heap #(
    parameter ENTRIES = 512,  // keys, 7 or more
    parameter KEY_BITS = 256,
    parameter COMPARED_BITS = 64,  // in front; no two keys are equal there
    parameter LEVELS = $clog2((ENTRIES + 1) / 2 + 1)
) (
    input clock,
    input reset,
    input clears,  // it is empty from the next cycle on, whatever is under way
    input begins,
    input inserts,  // or deletes, at an end
    input at_high,
    input [KEY_BITS-1:0] key,
    output [LEVELS:0] size,
    output [KEY_BITS-1:0] nearest,
    output [KEY_BITS-1:0] farthest,
    output [4*LEVELS-5:0] reads,  // a bit a bank, of levels 1 and so on
    output [4*LEVELS-5:0] writes
);
  // The root.
  reg is_here, is_insert, is_high;
  reg [LEVELS:0] held;
  reg [KEY_BITS-1:0] sinks, low, high;
  reg [LEVELS-1:0] below_left, below_right;
  wire changes, passes;
  wire [KEY_BITS-1:0] new_low, new_high;
  wire [LEVELS-1:0] new_below_left, new_below_right, left_room, right_room;
  assign size = is_here ? (is_insert ? held + 1'b1 : held - 1'b1) : held;
  assign nearest = is_here & changes ? new_low : low;
  assign farthest = size == 1 ? nearest : is_here & changes ? new_high : high;
  always @(posedge clock) begin
    is_here <= begins & ~reset;
    if (begins) begin
      is_insert <= inserts;
      is_high <= at_high;
      sinks <= key;
    end
    held <= reset | clears ? 0 : size;
    if (is_here & changes) {low, high} <= {new_low, new_high};
    if (is_here) {below_left, below_right} <= {new_below_left, new_below_right};
  end

  // Slot l: what comes to level l, and what the level above sees of its nodes.
  localparam L = LEVELS, K = KEY_BITS;
  wire [L:0] comes, insert_comes, high_comes, sides;
  wire [(L+1)*L-1:0] places;  // of operations at the level above
  wire [(L+1)*L-1:0] helds;
  wire [(L+1)*K-1:0] keys;
  wire [(L+1)*2*K-1:0] lefts, rights;
  wire [(L+1)*4-1:0] has_keys;
  wire [(L+2)*4-1:0] asked;
  wire unused = &{1'b0, comes, insert_comes, high_comes, sides, places, helds, keys, lefts, rights, has_keys,
                  asked};
  assign comes[0] = begins;
  assign {insert_comes[1:0], high_comes[1:0]} = {is_insert, inserts, is_high, at_high};
  assign sides[0] = 1'b0;
  assign {places[0+:2*L], helds[0+:L], keys[0+:K]} = 0;
  assign {lefts[0+:2*K], rights[0+:2*K], has_keys[0+:4]} = 0;
  assign {lefts[L*2*K+:2*K], rights[L*2*K+:2*K], has_keys[L*4+:4]} = 0;
  // A delete that begins reads the root's children, unless its two keys are all.
  wire reads_children = begins & ~inserts & held > 2;
  assign asked[0+:8] = {2'b0, {2{reads_children}} & {below_right != 0, below_left != 0}, 4'b0};

  child_room #(
      .ENTRIES(ENTRIES),
      .LEVEL(1),
      .LEVELS(L),
      .ROOM_BITS(L)
  ) of_left (
      .place(1'b0),
      .room(left_room)
  );
  child_room #(
      .ENTRIES(ENTRIES),
      .LEVEL(1),
      .LEVELS(L),
      .ROOM_BITS(L)
  ) of_right (
      .place(1'b1),
      .room(right_room)
  );
  heap_node #(
      .KEY_BITS(K),
      .COMPARED_BITS(COMPARED_BITS),
      .COUNT_BITS(L)
  ) root (
      .inserts(is_insert),
      .at_high(is_high),
      .held(held),
      .key(sinks),
      .low(low),
      .high(high),
      .below_left(below_left),
      .below_right(below_right),
      .left_room(left_room),
      .right_room(right_room),
      .left(lefts[2*K+:2*K]),
      .right(rights[2*K+:2*K]),
      .writes(changes),
      .new_low(new_low),
      .new_high(new_high),
      .new_below_left(new_below_left),
      .new_below_right(new_below_right),
      .goes_on(passes),
      .side(sides[1]),
      .held_below(helds[L+:L]),
      .sinking(keys[K+:K])
  );
  assign comes[1] = is_here & passes;
  ahead_reads #(
      .COUNT_BITS(L)
  ) ahead (
      .deletes(comes[1] & ~is_insert),
      .below_left(below_left),
      .below_right(below_right),
      .has_keys(has_keys[4+:4]),
      .reads(asked[8+:4])
  );

  genvar l;
  generate
    for (l = 1; l < L; l = l + 1) begin : levels
      localparam ABOVE = (1 << l) - 1, LEFT = (ENTRIES + 1) / 2 - ABOVE;
      localparam NODES = LEFT < ABOVE + 1 ? LEFT : ABOVE + 1;
      localparam WIDTH = 2 * (K + (l < L - 1 ? L - l : 0));
      localparam ADDRESS_BITS = NODES > 4 ? $clog2((NODES + 3) / 4) : 1;
      wire [4*WIDTH-1:0] read;
      wire [WIDTH-1:0] written;
      wire [ADDRESS_BITS-1:0] read_at, write_at;
      heap_level #(
          .LEVEL(l),
          .LEVELS(L),
          .ENTRIES(ENTRIES),
          .KEY_BITS(K),
          .COMPARED_BITS(COMPARED_BITS),
          .ADDRESS_BITS(ADDRESS_BITS)
      ) level (
          .clock(clock),
          .reset(reset),
          .comes(comes[l]),
          .inserts(insert_comes[l]),
          .at_high(high_comes[l]),
          .at_above(places[l*L+:(l>1?l-1:1)]),
          .side(sides[l]),
          .held(helds[l*L+:L-l+1]),
          .key(keys[l*K+:K]),
          .reads_ahead(asked[l*4+:4]),
          .ahead_at(places[(l-1)*L+:ADDRESS_BITS]),
          .left(lefts[l*2*K+:2*K]),
          .right(rights[l*2*K+:2*K]),
          .has_keys(has_keys[l*4+:4]),
          .left_child(lefts[(l+1)*2*K+:2*K]),
          .right_child(rights[(l+1)*2*K+:2*K]),
          .has_keys_below(has_keys[(l+1)*4+:4]),
          .goes_on(comes[l+1]),
          .inserts_here(insert_comes[l+1]),
          .at_high_here(high_comes[l+1]),
          .at_here(places[(l+1)*L+:l]),
          .side_below(sides[l+1]),
          .held_below(helds[(l+1)*L+:L-l]),
          .sinking(keys[(l+1)*K+:K]),
          .asks_ahead(asked[(l+2)*4+:4]),
          .reads(reads[(l-1)*4+:4]),
          .read_at(read_at),
          .read(read),
          .writes(writes[(l-1)*4+:4]),
          .write_at(write_at),
          .written(written)
      );
      assign places[(l+1)*L+l+:L-l] = 0;
      assign helds[(l+1)*L+L-l+:l] = 0;
      heap_memory #(
          .NODES(NODES),
          .WIDTH(WIDTH),
          .ADDRESS_BITS(ADDRESS_BITS)
      ) memory (
          .clock(clock),
          .reads(reads[(l-1)*4+:4]),
          .read_at(read_at),
          .read(read),
          .writes(writes[(l-1)*4+:4]),
          .write_at(write_at),
          .written(written)
      );
    end
  endgenerate
endmodule
