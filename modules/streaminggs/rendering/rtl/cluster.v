// A cluster: blends a sub-tile every three cycles, in the order of its queue, and has the pixels of its
// sub-tiles. A splat waits until the one ahead on the same sub-tile has left the loop through the
// pixels.
module cluster #(
    parameter QUEUE_ENTRIES = 8,
    parameter STATE_LOOP_CYCLES = 9,  // 9 or more
    parameter DEPTH_CYCLES = 47,      // 46 or more
    parameter SUBTILES = 144
) (
    input clock,
    input reset,
    input turn,               // one cycle in three
    input [1:0] phase,        // of the blend that begins behind that cycle
    input [9:0] group_width,  // px
    input [9:0] group_height,
    // From the dispatcher: a splat on a sub-tile.
    input is_pushed,
    input [287:0] splat,
    input [15:0] group_x,     // the group's first sub-tile in the frame
    input [15:0] group_y,
    input [7:0] x,            // of the group
    input [7:0] y,
    input [7:0] address,      // among this cluster's sub-tiles
    output has_room,
    output is_idle,
    // News of a sub-tile that is finished.
    output finishes,
    output [7:0] finished_x,
    output [7:0] finished_y,
    // Draining: a sub-tile is read, another one cleared.
    input drains,
    input [7:0] drained,
    output [2047:0] pixels,
    input clears,
    input [7:0] cleared
);
  localparam INTERVAL = 3;
  localparam LOOP_TURNS = (STATE_LOOP_CYCLES + INTERVAL - 1) / INTERVAL;
  localparam READ = 12, WRITE = 14;  // stages of a blend, of three cycles

  // The queue. Room that is made in a cycle is seen in it.
  localparam POINTER_BITS = $clog2(QUEUE_ENTRIES);
  localparam [31:0] LAST = QUEUE_ENTRIES - 1;
  reg [311:0] queue[0:QUEUE_ENTRIES-1];
  reg [POINTER_BITS-1:0] head, tail;
  reg [POINTER_BITS:0] fill;
  wire [311:0] first = queue[head];
  wire [7:0] first_address = first[311:304], first_y = first[303:296], first_x = first[295:288];

  // The scoreboard: sub-tiles taken in the last turns.
  reg [LOOP_TURNS-2:0] in_loop;
  reg [(LOOP_TURNS-1)*8-1:0] looping;
  reg is_blocked;
  integer i;
  always @* begin
    is_blocked = 1'b0;
    for (i = 0; i < LOOP_TURNS - 1; i = i + 1)
      if (in_loop[i] & looping[8*i+:8] == first_address) is_blocked = 1'b1;
  end
  wire takes = turn & fill != 0 & ~is_blocked;
  assign has_room = fill != QUEUE_ENTRIES | takes;
  reg is_busy;
  assign is_idle = fill == 0 & ~is_busy;
  always @(posedge clock) begin
    if (is_pushed) queue[tail] <= {address, y, x, splat};
    tail <= reset ? 0 : is_pushed ? (tail == LAST[POINTER_BITS-1:0] ? 0 : tail + 1'b1) : tail;
    head <= reset ? 0 : takes ? (head == LAST[POINTER_BITS-1:0] ? 0 : head + 1'b1) : head;
    fill <= reset ? 0 : fill + {{POINTER_BITS{1'b0}}, is_pushed} - {{POINTER_BITS{1'b0}}, takes};
    is_busy <= ~reset & (takes | (is_busy & phase != 2'd1));
    if (reset) in_loop <= 0;
    else if (turn) in_loop <= {in_loop[LOOP_TURNS-3:0], takes};
    if (turn) looping <= {looping[(LOOP_TURNS-2)*8-1:0], first_address};
  end

  // Sub-tiles under way: those that are there, their place, the lowest stage the youngest.
  reg [WRITE:0] is_there;
  reg [7:0] xs[0:WRITE], ys[0:WRITE], addresses[0:WRITE];
  always @(posedge clock) begin
    if (turn) begin
      is_there <= {is_there[WRITE-1:0], takes};
      xs[0] <= first_x;
      ys[0] <= first_y;
      addresses[0] <= first_address;
      for (i = 1; i <= WRITE; i = i + 1) begin
        xs[i] <= xs[i-1];
        ys[i] <= ys[i-1];
        addresses[i] <= addresses[i-1];
      end
    end
    if (reset) is_there <= 0;
  end

  wire [31:0] left, top;
  wire [15:0] frame_x = group_x + {8'b0, first_x}, frame_y = group_y + {8'b0, first_y};
  whole_number of_left (
      .whole({2'b0, frame_x, 2'b0}),
      .number(left)
  );
  whole_number of_top (
      .whole({2'b0, frame_y, 2'b0}),
      .number(top)
  );

  wire [15:0] is_inside, writes_light, writes_colour;
  wire [2047:0] results;
  wire all_finished;
  subtile_blend blend (
      .clock(clock),
      .phase(phase),
      .splat(first[287:0]),
      .left(left),
      .top(top),
      .is_inside(is_inside),
      .states(pixels),
      .writes_light(writes_light),
      .writes_colour(writes_colour),
      .results(results),
      .is_finished(all_finished)
  );

  // Pixels, a memory for each place in a sub-tile.
  localparam [127:0] CLEAR = {32'h3F800000, 96'b0};
  wire writes = is_there[WRITE] & phase == 2'd2;
  genvar k;
  generate
    for (k = 0; k < 16; k = k + 1) begin : places
      localparam [9:0] ACROSS = k % 4, DOWN = k / 4;
      wire [9:0] pixel_x = {xs[READ], 2'b0} + ACROSS, pixel_y = {ys[READ], 2'b0} + DOWN;
      assign is_inside[k] = pixel_x < group_width & pixel_y < group_height;
      pixel_memory #(
          .ENTRIES(SUBTILES),
          .ADDRESS_BITS(8)
      ) memory (
          .clock(clock),
          .reads(drains | phase == 2'd0),
          .read_at(drains ? drained : addresses[READ]),
          .read(pixels[k*128+:128]),
          .writes_light(clears | (writes & writes_light[k])),
          .writes_colour(clears | (writes & writes_colour[k])),
          .write_at(clears ? cleared : addresses[WRITE]),
          .written(clears ? CLEAR : results[k*128+:128])
      );
    end
  endgenerate

  // A sub-tile is known to be finished in the cycle behind this news.
  localparam LATER = DEPTH_CYCLES - 46;
  wire [(LATER+1)*17-1:0] news;
  assign news[16:0] = {writes & all_finished, ys[WRITE], xs[WRITE]};
  generate
    for (k = 0; k < LATER; k = k + 1) begin : later
      reg [16:0] held;
      always @(posedge clock) held <= news[k*17+:17] & {~reset, 16'hFFFF};
      assign news[(k+1)*17+:17] = held;
    end
  endgenerate
  assign {finishes, finished_y, finished_x} = news[LATER*17+:17];
endmodule
