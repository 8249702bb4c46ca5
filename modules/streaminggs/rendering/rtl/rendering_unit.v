// The rendering unit: blends the splats of one group after the other, front to back, and drains each.
// Timing: that of modules/streaminggs/rendering/cluster_schedule.h.
module rendering_unit #(
    parameter COLUMNS = 24,  // sub-tiles of a group
    parameter ROWS = 24,
    parameter CLUSTERS = 4,
    parameter QUEUE_ENTRIES = 8,
    parameter STATE_LOOP_CYCLES = 9,
    parameter DEPTH_CYCLES = 47,
    parameter DRAIN_DEPTH_CYCLES = 10,
    parameter SPAN_SLOTS = 48  // of span_pipeline.v
) (
    input clock,
    input reset,
    input [15:0] group_x,  // of the group that is open: its first sub-tile in the frame
    input [15:0] group_y,
    input [9:0] group_width,  // px
    input [9:0] group_height,
    output reg is_open,
    // Tokens: splats, nothing, the end of a group.
    input is_token,
    input is_splat,
    input is_end,
    input [287:0] splat,     // x, y, conic a, b, c, opacity, red, green, blue; x the lowest
    input [31:0] footprint,  // sub-tiles of the group: x0, y0, x1, y1; x0 the lowest
    output takes,
    output closes,           // the open group's last sub-tile is on its way
    output is_hidden,        // the splat that is taken reaches nothing
    output [CLUSTERS-1:0] pushes,
    // Eight pixels of the group that drains: pixel_memory.v; the first the lowest.
    output has_pixels,
    output [9:0] pixel_x,    // the first one, of the group
    output [9:0] pixel_y,
    output [1023:0] pixels,
    output drain_ends
);
  localparam SUBTILES = COLUMNS * ROWS;
  localparam CLUSTER_BITS = $clog2(CLUSTERS);
  localparam SLOT_BITS = $clog2(SPAN_SLOTS);
  localparam [31:0] LAST_SLOT = SPAN_SLOTS - 1;
  localparam SPAN_ENTRIES = SPAN_SLOTS * ROWS, SPAN_BITS = $clog2(SPAN_ENTRIES);
  localparam [31:0] LAST_SPAN = SPAN_ENTRIES - 1;

  // Tokens are taken while there is a slot, and no splat waits for its turn to begin.
  wire [7:0] x0 = footprint[7:0], y0 = footprint[15:8], x1 = footprint[23:16], y1 = footprint[31:24];
  wire [7:0] across = x1 - x0, down = y1 - y0;
  wire is_spanned = across > 4 | down > 4 | (across > 2 & down > 1) | (across > 1 & down > 2);
  reg [SUBTILES-1:0] finished;
  reg [SUBTILES-1:0] in_box;
  integer i, j;
  always @* begin
    for (i = 0; i < ROWS; i = i + 1)
      for (j = 0; j < COLUMNS; j = j + 1)
        in_box[i*COLUMNS+j] = j >= {24'b0, x0} & j < {24'b0, x1} & i >= {24'b0, y0} & i < {24'b0, y1};
  end
  assign is_hidden = (in_box & ~finished) == 0;

  reg has_ended, waits_to_begin;
  reg [SLOT_BITS:0] used;
  wire begin_turn;
  assign takes = is_open & ~has_ended & ~waits_to_begin & is_token & used != SPAN_SLOTS;
  wire is_taken = takes & is_splat & ~is_hidden;
  reg [223:0] waiting;
  wire begins = begin_turn & (waits_to_begin | (is_taken & is_spanned));
  wire splat_ends;
  always @(posedge clock) begin
    waits_to_begin <= ~reset & ~begin_turn & (waits_to_begin | (is_taken & is_spanned));
    if (is_taken) waiting <= {footprint, splat[191:0]};
    has_ended <= ~reset & ~closes & (has_ended | (takes & is_end));
    used <= reset ? 0 : used + {{SLOT_BITS{1'b0}}, is_taken} - {{SLOT_BITS{1'b0}}, splat_ends};
  end

  // Spans, in the order in which the dispatcher takes them.
  wire span_comes;
  wire [7:0] span_first, span_past;
  span_pipeline span_lanes (
      .clock(clock),
      .reset(reset),
      .group_x(group_x),
      .group_y(group_y),
      .begin_turn(begin_turn),
      .begins(begins),
      .splat(waits_to_begin ? waiting[191:0] : splat[191:0]),
      .footprint(waits_to_begin ? waiting[223:192] : footprint),
      .ends(span_comes),
      .first(span_first),
      .past(span_past)
  );
  reg [15:0] spans[0:SPAN_ENTRIES-1];
  reg [SPAN_BITS-1:0] span_written, span_read;
  reg [SPAN_BITS:0] span_fill;
  reg [15:0] span;
  reg has_span;
  wire takes_span;
  wire [SPAN_BITS-1:0] span_next = ~takes_span ? span_read :
      span_read == LAST_SPAN[SPAN_BITS-1:0] ? 0 : span_read + 1'b1;
  always @(posedge clock) begin
    if (span_comes) spans[span_written] <= {span_past, span_first};
    span_written <= reset ? 0 : ~span_comes ? span_written :
        span_written == LAST_SPAN[SPAN_BITS-1:0] ? 0 : span_written + 1'b1;
    span <= spans[span_next];
    has_span <= ~reset & span_fill != {{SPAN_BITS{1'b0}}, takes_span};
    span_fill <= reset ? 0 : span_fill + {{SPAN_BITS{1'b0}}, span_comes} - {{SPAN_BITS{1'b0}}, takes_span};
    span_read <= reset ? 0 : span_next;
  end

  // Slots. log2(e) goes into the conic on the way there.
  localparam [31:0] HALF_FACTOR = 32'hBF38AA3B, FACTOR = 32'hBFB8AA3B;  // -log2(e) / 2, -log2(e)
  wire [31:0] log2_a, log2_b, log2_c;
  reg [1:0] is_coming;
  reg [224:0] coming[0:1];  // spanned, footprint, colours, opacity, y, x
  chaining_product of_a (
      .clock(clock),
      .a(splat[95:64]),
      .b(HALF_FACTOR),
      .product(log2_a)
  );
  chaining_product of_b (
      .clock(clock),
      .a(splat[127:96]),
      .b(FACTOR),
      .product(log2_b)
  );
  chaining_product of_c (
      .clock(clock),
      .a(splat[159:128]),
      .b(HALF_FACTOR),
      .product(log2_c)
  );
  reg [320:0] slots[0:SPAN_SLOTS-1];
  reg [SLOT_BITS-1:0] slot_written, slot_read;
  reg [SLOT_BITS:0] slot_fill;
  reg [320:0] held;
  reg has_splat;
  wire [SLOT_BITS-1:0] slot_next = ~splat_ends ? slot_read :
      slot_read == LAST_SLOT[SLOT_BITS-1:0] ? 0 : slot_read + 1'b1;
  always @(posedge clock) begin
    is_coming <= {is_coming[0], is_taken} & {2{~reset}};
    coming[0] <= {is_spanned, footprint, splat[287:160], splat[63:0]};
    coming[1] <= coming[0];
    if (is_coming[1]) slots[slot_written] <= {coming[1][224:64], log2_c, log2_b, log2_a, coming[1][63:0]};
    slot_written <= reset ? 0 : ~is_coming[1] ? slot_written :
        slot_written == LAST_SLOT[SLOT_BITS-1:0] ? 0 : slot_written + 1'b1;
    held <= slots[slot_next];
    has_splat <= ~reset & slot_fill != {{SLOT_BITS{1'b0}}, splat_ends};
    slot_fill <= reset ? 0 : slot_fill + {{SLOT_BITS{1'b0}}, is_coming[1]} - {{SLOT_BITS{1'b0}}, splat_ends};
    slot_read <= reset ? 0 : slot_next;
  end

  // Rows of the oldest splat, of which the dispatcher holds one.
  wire held_is_spanned = held[320];
  wire [7:0] held_x0 = held[295:288], held_y0 = held[303:296], held_x1 = held[311:304],
      held_y1 = held[319:312];
  reg [7:0] rows_done;
  wire [7:0] row = held_y0 + rows_done;
  wire holds = has_splat & (~held_is_spanned | has_span);
  wire row_ends;
  wire [CLUSTERS-1:0] has_room;
  wire [CLUSTERS*8-1:0] columns;
  wire [CLUSTER_BITS-1:0] shift = cluster_of(0, row[CLUSTER_BITS-2:0]);
  wire [COLUMNS-1:0] row_finished = finished[row*COLUMNS+:COLUMNS];
  dispatcher #(
      .COLUMNS(COLUMNS),
      .CLUSTERS(CLUSTERS)
  ) dispatch (
      .clock(clock),
      .reset(reset),
      .holds(holds),
      .first(held_is_spanned ? span[7:0] : held_x0),
      .past(held_is_spanned ? span[15:8] : held_x1),
      .shift(shift),
      .finished(row_finished),
      .has_room(has_room),
      .row_ends(row_ends),
      .pushes(pushes),
      .columns(columns)
  );
  assign takes_span = row_ends & held_is_spanned;
  assign splat_ends = row_ends & row + 8'd1 == held_y1;
  always @(posedge clock) rows_done <= reset | splat_ends ? 0 : row_ends ? rows_done + 1 : rows_done;

  // A sub-tile's cluster, and its place among those of the cluster.
  function [CLUSTER_BITS-1:0] cluster_of(input [CLUSTER_BITS-1:0] column, input [CLUSTER_BITS-2:0] row_of_group);
    cluster_of = column + group_x[CLUSTER_BITS-1:0] + {row_of_group + group_y[CLUSTER_BITS-2:0], 1'b0};
  endfunction
  function [7:0] address_of(input [7:0] column, input [7:0] row_of_group);
    address_of = row_of_group * (COLUMNS / CLUSTERS) + (column >> CLUSTER_BITS);
  endfunction

  // The group: blended, then on its way through the last stages, then drained.
  reg [7:0] wait_cycles;
  reg is_waiting;
  wire [CLUSTERS-1:0] is_idle;
  assign closes = is_open & has_ended & used == 0 & (&is_idle);
  wire drain_begins = is_waiting & wait_cycles == 0;
  always @(posedge clock) begin
    is_open <= reset | drain_ends | (is_open & ~closes);
    is_waiting <= ~reset & (closes | (is_waiting & ~drain_begins));
    wait_cycles <= closes ? DEPTH_CYCLES + DRAIN_DEPTH_CYCLES - 2 : wait_cycles - 1;
  end
  wire [9:0] drain_x, drain_y;
  wire drain_reads, drain_clears;
  wire unused = &{1'b0, drain_x[1:0], drain_y[1:0]};
  drain draining (
      .clock(clock),
      .reset(reset),
      .begins(drain_begins),
      .width(group_width),
      .height(group_height),
      .x(drain_x),
      .y(drain_y),
      .reads(drain_reads),
      .read_x(pixel_x),
      .read_y(pixel_y),
      .has_read(has_pixels),
      .clears(drain_clears),
      .ends(drain_ends)
  );
  wire [CLUSTER_BITS-1:0] drain_cluster = cluster_of(pixel_x[CLUSTER_BITS+1:2], pixel_y[CLUSTER_BITS:2]);
  wire [CLUSTER_BITS-1:0] drain_cluster_2 = drain_cluster + 1'b1;
  wire [CLUSTERS*2048-1:0] of_clusters;
  assign pixels = {of_clusters[{drain_cluster_2, pixel_y[1:0]}*512+:512],
                   of_clusters[{drain_cluster, pixel_y[1:0]}*512+:512]};

  // All sub-tiles are cleared in reset, which lasts for as many cycles as a cluster has.
  reg [7:0] reset_at;
  always @(posedge clock) reset_at <= reset ? reset_at + 8'd1 : 8'd0;

  // Clusters.
  reg [1:0] phase;  // of blends
  wire turn = phase == 2'd2;
  always @(posedge clock) phase <= reset ? 2'd2 : turn ? 2'd0 : phase + 2'd1;
  wire [CLUSTERS-1:0] finishes;
  wire [CLUSTERS*8-1:0] finished_x, finished_y;
  genvar k;
  generate
    for (k = 0; k < CLUSTERS; k = k + 1) begin : clusters
      wire [7:0] column = columns[k*8+:8];
      wire clears = drain_clears & (drain_cluster == k | drain_cluster_2 == k);
      cluster #(
          .QUEUE_ENTRIES(QUEUE_ENTRIES),
          .STATE_LOOP_CYCLES(STATE_LOOP_CYCLES),
          .DEPTH_CYCLES(DEPTH_CYCLES),
          .SUBTILES(SUBTILES / CLUSTERS)
      ) one (
          .clock(clock),
          .reset(reset),
          .turn(turn),
          .phase(phase),
          .group_width(group_width),
          .group_height(group_height),
          .is_pushed(pushes[k]),
          .splat(held[287:0]),
          .group_x(group_x),
          .group_y(group_y),
          .x(column),
          .y(row),
          .address(address_of(column, row)),
          .has_room(has_room[k]),
          .is_idle(is_idle[k]),
          .finishes(finishes[k]),
          .finished_x(finished_x[k*8+:8]),
          .finished_y(finished_y[k*8+:8]),
          .drains(drain_reads),
          .drained(address_of(drain_x[9:2], drain_y[9:2])),
          .pixels(of_clusters[k*2048+:2048]),
          .clears(reset | clears),
          .cleared(reset ? reset_at : address_of(pixel_x[9:2], pixel_y[9:2]))
      );
    end
  endgenerate

  always @(posedge clock) begin
    for (i = 0; i < CLUSTERS; i = i + 1)
      if (finishes[i]) finished[finished_y[i*8+:8]*COLUMNS+finished_x[i*8+:8]] <= 1'b1;
    if (reset | drain_ends) finished <= 0;
  end
endmodule
