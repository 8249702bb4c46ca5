// Spans of the rows of splats, in order: a splat begins in each of its turns at most, a row of sub-tiles
// in each of theirs.
module span_pipeline (
    input clock,
    input reset,
    input [15:0] group_x,     // the group's first sub-tile in the frame
    input [15:0] group_y,
    output begin_turn,
    input begins,             // a splat, in that turn; at most SLOTS are under way
    input [191:0] splat,      // x, y, conic a, b, c, opacity; x the lowest
    input [31:0] footprint,   // sub-tiles of the group: x0, y0, x1, y1; x0 the lowest
    output ends,              // a row's span is there
    output reg [7:0] first,   // its sub-tiles
    output reg [7:0] past
);
  /* verilator hier_block */
  localparam SLOTS = 48, BEGIN_LANES = 11, BEGIN_INTERVAL = 7, SPAN_LANES = 10;
  localparam SPAN_INTERVAL = 2;  // or more
  localparam SLOT_BITS = $clog2(SLOTS);
  localparam [SLOT_BITS-1:0] LAST_SLOT = SLOTS - 1;

  reg [7:0] begin_phase, span_phase;
  assign begin_turn = begin_phase == BEGIN_INTERVAL - 1;
  wire span_turn = span_phase == SPAN_INTERVAL - 1;
  always @(posedge clock) begin
    begin_phase <= reset ? BEGIN_INTERVAL - 1 : begin_turn ? 0 : begin_phase + 1;
    span_phase <= reset ? SPAN_INTERVAL - 1 : span_turn ? 0 : span_phase + 1;
  end

  // Splats that have begun, or are about to: by slot.
  reg [95:0] places[0:SLOTS-1];  // x, y, footprint
  reg [256:0] begun[0:SLOTS-1];
  reg [SLOT_BITS-1:0] next, written, read, ended;
  function [SLOT_BITS-1:0] behind(input [SLOT_BITS-1:0] slot);
    behind = slot == LAST_SLOT ? 0 : slot + 1;
  endfunction

  wire [31:0] first_line;
  row_line above_first (
      .row(group_y + {8'b0, footprint[15:8]}),
      .line(first_line)
  );
  wire is_begun, bounded;
  wire [255:0] words;
  span_begin #(
      .LANES(BEGIN_LANES),
      .INTERVAL(BEGIN_INTERVAL)
  ) beginning (
      .clock(clock),
      .phase(begin_phase),
      .begins(begins),
      .y(splat[63:32]),
      .conic_a(splat[95:64]),
      .conic_b(splat[127:96]),
      .conic_c(splat[159:128]),
      .opacity(splat[191:160]),
      .line(first_line),
      .ends(is_begun),
      .bounded(bounded),
      .begun(words)
  );
  always @(posedge clock) begin
    if (begins) places[next] <= {footprint, splat[63:0]};
    if (is_begun) begun[written] <= {bounded, words};
    next <= reset ? 0 : begins ? behind(next) : next;
    written <= reset ? 0 : is_begun ? behind(written) : written;
  end

  // Rows of the oldest one, of which the words are fetched ahead.
  reg [SLOT_BITS:0] waiting;  // begun, their rows not all
  reg is_fetched;
  reg [79:0] place;   // x, y, first and last row
  reg [255:0] words_of_splat;
  reg [7:0] row;  // of the group
  reg is_first;
  wire [7:0] row_now = is_first ? place[71:64] : row;
  wire row_begins = is_fetched & span_turn;
  wire is_last = row_now + 8'd1 == place[79:72];
  always @(posedge clock) begin
    place <= {places[read][95:88], places[read][79:72], places[read][63:0]};
    words_of_splat <= begun[read][255:0];
    is_fetched <= ~reset & waiting != 0 & ~row_begins;
    waiting <= reset ? 0 : waiting + {{SLOT_BITS{1'b0}}, is_begun} - {{SLOT_BITS{1'b0}}, row_begins & is_last};
    if (row_begins) row <= row_now + 8'd1;
    is_first <= reset | (row_begins ? is_last : is_first);
    read <= reset ? 0 : row_begins & is_last ? behind(read) : read;
  end
  wire [15:0] row_in_frame = group_y + {8'b0, row_now};
  wire [31:0] top_line, bottom_line;
  row_line top (
      .row(row_in_frame),
      .line(top_line)
  );
  row_line bottom (
      .row(row_in_frame + 16'd1),
      .line(bottom_line)
  );
  wire [31:0] low, high;
  row_span #(
      .LANES(SPAN_LANES),
      .INTERVAL(SPAN_INTERVAL)
  ) rows (
      .clock(clock),
      .phase(span_phase),
      .begins(row_begins),
      .is_first(is_first),
      .begun({words_of_splat, place[63:0]}),
      .top_line(top_line),
      .bottom_line(bottom_line),
      .ends(ends),
      .low(low),
      .high(high)
  );

  // The sub-tiles of the bounds, within the footprint.
  reg [7:0] rows_ended;
  wire [31:0] box = places[ended][95:64];
  wire is_whole = ~begun[ended][256];
  wire box_ends = box[15:8] + rows_ended + 8'd1 == box[31:24];
  always @(posedge clock) begin
    rows_ended <= reset | (ends & box_ends) ? 0 : ends ? rows_ended + 1 : rows_ended;
    ended <= reset ? 0 : ends & box_ends ? behind(ended) : ended;
  end
  wire [31:0] low_pixel;
  rounding up (
      .to(2'd2),
      .x(low),
      .whole(low_pixel)
  );
  wire [17:0] low_column, high_column;
  subtile_column left (
      .x(low_pixel),
      .column(low_column)
  );
  subtile_column right (
      .x(high),
      .column(high_column)
  );
  wire [17:0] from = low_column - {2'b0, group_x};
  wire [17:0] to = high_column + 18'd1 - {2'b0, group_x};
  wire from_is_inside = ~from[17] & from > {10'b0, box[7:0]};
  wire to_is_inside = to[17] | to < {10'b0, box[23:16]};
  always @* begin
    first = is_whole | ~from_is_inside ? box[7:0] : from > 18'd255 ? 8'd255 : from[7:0];
    past = is_whole | ~to_is_inside ? box[23:16] : to[17] ? 8'd0 : to[7:0];
  end
endmodule
