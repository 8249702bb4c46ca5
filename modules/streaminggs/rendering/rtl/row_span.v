// The span of a row of a splat's sub-tiles (RowSpans in algorithm/splat/row_span.h): bounds along x, px,
// of what may be visible in it. The next row of a splat follows in the next turn.
module row_span #(
    parameter LANES = 10,
    parameter INTERVAL = 2
) (
    input clock,
    input [7:0] phase,
    input begins,            // a row comes, in the last phase
    input is_first,          // of its splat
    input [319:0] begun,     // of span_begin.v
    input [31:0] top_line,   // half a pixel above the row
    input [31:0] bottom_line,
    output ends,
    output [31:0] low,
    output [31:0] high
);
  localparam [7:0] SUM = 8'h00, EXACT = 8'h20, PRODUCT = 8'h40, OUTSIDE = 8'h80, MINUS_A = 8'h10,
      MINUS_C = 8'h08;
  localparam STEPS = 27, INPUTS = 12, CONSTANTS = 3;
  localparam [7:0] X = 128, Y = 129, SLOPE = 130, RADICAND = 131, BEND = 132, HALF_WIDTH = 133,
      RIGHT_AT = 134, SLACK = 135, EDGE_LEFT = 136, EDGE_RIGHT = 137, TOP_LINE = 138,
      BOTTOM_LINE = 139;
  localparam [7:0] ONE = 192, HALF = 193, NOTHING = 194;
  localparam [7:0] TOP = 0, BOTTOM = 1, EXTREME = 2, MIDDLE = 3, BEND_DY = 4, UNDER_ROOT = 5,
      TWICE_H0 = 6, G0 = 7, H0 = 8, R1 = 9, H1 = 10, G1 = 11, R2 = 12, H2 = 13, G2 = 14, REST = 15,
      ROOT = 16, LEFT = 17, FAR_LEFT = 18, LOW_1 = 19, LOW = 20, MOST_LEFT = 21, RIGHT = 22,
      MOST_RIGHT = 23, FAR_RIGHT = 24, HIGH_1 = 25, HIGH = 26;
  localparam [STEPS*32-1:0] PROGRAM = {
    {SUM | MINUS_C, TOP_LINE, ONE, Y},
    {SUM | MINUS_C, BOTTOM_LINE, ONE, Y},
    {OUTSIDE, TOP, BOTTOM, RIGHT_AT},
    {PRODUCT, SLOPE, BOTTOM, NOTHING},
    {PRODUCT, BEND, BOTTOM, NOTHING},
    {SUM | MINUS_A, BEND_DY, BOTTOM, RADICAND},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {PRODUCT, UNDER_ROOT, TWICE_H0, NOTHING},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {EXACT | MINUS_A, G0, H0, HALF},
    {EXACT, H0, R1, H0},
    {EXACT, G0, R1, G0},
    {EXACT | MINUS_A, G1, H1, HALF},
    {EXACT, H1, R2, H1},
    {EXACT, G1, R2, G1},
    {EXACT | MINUS_A, G2, G2, UNDER_ROOT},
    {EXACT, REST, H2, G2},
    {SUM | MINUS_A, ROOT, ONE, MIDDLE},
    {OUTSIDE, LEFT, EXTREME, HALF_WIDTH},
    {SUM | MINUS_A, FAR_LEFT, ONE, X},
    {SUM | MINUS_C, LOW_1, ONE, SLACK},
    {OUTSIDE, LEFT, UNDER_ROOT, EDGE_LEFT},
    {SUM, ROOT, ONE, MIDDLE},
    {OUTSIDE, RIGHT, UNDER_ROOT, EDGE_RIGHT},
    {OUTSIDE, RIGHT, EXTREME, HALF_WIDTH},
    {SUM, FAR_RIGHT, ONE, X},
    {SUM, HIGH_1, ONE, SLACK}
  };
  localparam [CONSTANTS*32-1:0] NUMBERS = {32'h80000000, 32'h3F000000, 32'h3F800000};
  localparam [STEPS-1:0] KEPT = (1 << LOW) | (1 << HIGH);

  // Nothing is made here of the steps of lanes.
  /* verilator lint_off UNDRIVEN */
  /* verilator lint_off UNUSEDSIGNAL */
  wire [STEPS*128-1:0] operands;
  wire [STEPS*32-1:0] outside, kept;
  /* verilator lint_on UNUSEDSIGNAL */
  /* verilator lint_on UNDRIVEN */
  // An edge of ones: that of the row before.
  wire [INPUTS*32-1:0] inputs = {bottom_line, top_line, begun[319:256] | {64{~is_first}}, begun[255:0]};
  folded_lanes #(
      .STEPS(STEPS),
      .INPUTS(INPUTS),
      .CONSTANTS(CONSTANTS),
      .LANES(LANES),
      .INTERVAL(INTERVAL),
      .PROGRAM(PROGRAM),
      .NUMBERS(NUMBERS),
      .KEPT(KEPT)
  ) steps (
      .clock(clock),
      .phase(phase),
      .begins(begins),
      .inputs(inputs),
      .operands(operands),
      .outside(outside),
      .kept(kept),
      .ends(ends)
  );
  assign low = kept[LOW*32+:32];
  assign high = kept[HIGH*32+:32];

  // The root: its seed, which is 0 of 0, as the root is then.
  wire [31:0] seed;
  root_seed from (
      .x(operands[H0*128+16+:15]),
      .seed(seed)
  );
  wire [31:0] not_0 = {32{operands[H0*128+23+:8] != 0}};
  assign outside[H0*32+:32] = seed & not_0;
  assign outside[TWICE_H0*32+:32] = {seed[31], seed[30:23] + 8'd1, seed[22:0]} & not_0;

  // Whether the ellipse's extremes lie in the row.
  wire [31:0] top = operands[EXTREME*128+:32], bottom = operands[EXTREME*128+32+:32];
  wire [31:0] right_at = operands[EXTREME*128+64+:32];
  wire is_right, is_left;
  between right_extreme (
      .low(top),
      .high(bottom),
      .x(right_at),
      .is(is_right)
  );
  between left_extreme (
      .low(top),
      .high(bottom),
      .x({~right_at[31], right_at[30:0]}),
      .is(is_left)
  );
  assign outside[EXTREME*32+:32] = {30'b0, is_left, is_right};

  // The farther one of both edges of a row, or the extreme: steps of one cycle.
  wire [31:0] most_right, most_left;
  row_edge right_edge (
      .clock(clock),
      .now(operands[MOST_RIGHT*128+96]),
      .bound(operands[MOST_RIGHT*128+:32]),
      .under_root(operands[MOST_RIGHT*128+32+:32]),
      .begun(operands[MOST_RIGHT*128+64+:32]),
      .most(most_right)
  );
  row_edge left_edge (
      .clock(clock),
      .now(operands[MOST_LEFT*128+96]),
      .bound(operands[MOST_LEFT*128+:32] ^ 32'h80000000),
      .under_root(operands[MOST_LEFT*128+32+:32]),
      .begun(operands[MOST_LEFT*128+64+:32] ^ 32'h80000000),
      .most(most_left)
  );
  assign outside[MOST_RIGHT*32+:32] = most_right;
  assign outside[MOST_LEFT*32+:32] = most_left;
  assign outside[FAR_RIGHT*32+:32] = operands[FAR_RIGHT*128+32] ? operands[FAR_RIGHT*128+64+:32] :
      most_right;
  assign outside[FAR_LEFT*32+:32] = operands[FAR_LEFT*128+33] ? operands[FAR_LEFT*128+64+:32] :
      most_left;
endmodule
