// What the spans of a splat's rows begin with (RowSpans in algorithm/splat/row_span.h).
module span_begin #(
    parameter LANES = 11,
    parameter INTERVAL = 7
) (
    input clock,
    input [7:0] phase,
    input begins,         // a splat comes, in the last phase
    input [31:0] y,
    input [31:0] conic_a,
    input [31:0] conic_b,
    input [31:0] conic_c,
    input [31:0] opacity,
    input [31:0] line,    // half a pixel above its first row
    output ends,
    output bounded,       // else its rows are whole
    output [255:0] begun  // slope, radicand, bend, half width, right at, slack, edge left, edge right;
                          // slope the lowest
);
  localparam [31:0] EVERYWHERE = 32'h7149F2CA, MOST_HALF_WIDTH = 32'h7149F2C9;  // 1e30, and the one below
  localparam [31:0] MOST_WIDENING = 32'h3EFFFFFF;  // below 1/2

  localparam [7:0] SUM = 8'h00, EXACT = 8'h20, PRODUCT = 8'h40, OUTSIDE = 8'h80, MINUS_A = 8'h10,
      MINUS_C = 8'h08;
  localparam STEPS = 90, INPUTS = 6, CONSTANTS = 12;
  localparam [7:0] Y = 128, A = 129, B = 130, C = 131, OPACITY = 132, LINE = 133;
  localparam [7:0] ONE = 192, HALF = 193, NOTHING = 194, TWO = 195, EPSILON = 196, MOST_LEVEL = 197,
      LN2 = 198, THIRD = 199, QUARTER = 200, ROOM = 201, RELATIVE = 202, SLACK_PX = 203;
  localparam [7:0] TRACE = 0, AC = 1, DETERMINANT = 2, LEVEL = 3, TRACE_2 = 4, Z = 5, POWER = 6,
      INVERSE = 7, LOGARITHM = 8, D0 = 9, D_E1 = 10, D1 = 11, D_E2 = 12, D2 = 13, PER_D = 14,
      K0 = 15, K_REST = 16, CONDITION = 17, NARROW = 18, WIDENING = 19, WIDE = 20, A0 = 21,
      A_E1 = 22, A1 = 23, A_E2 = 24, A2 = 25, A3 = 26, A_REST = 27, PER_A = 28, R = 29, L0 = 30,
      R_2 = 31, L1 = 32, L2 = 33, L3 = 34, LOG = 35, CUTOFF = 36, WIDE_CUTOFF = 37,
      UNDER_RATIO = 38, W0 = 39, W_REST = 40, RATIO = 41, RADICAND = 42, DY = 43, D_PER_A = 44,
      BEND = 45, BEND_DY = 46, UNDER_ROOT = 47, H0 = 48, TWICE_H0 = 49, G0 = 50, R1 = 51, G1 = 52,
      H1 = 53, R2 = 54, G2 = 55, H2 = 56, REST = 57, HALF_WIDTH = 58, C0 = 59, C_E1 = 60, C1 = 61,
      C_E2 = 62, C2 = 63, PER_C = 64, EH0 = 65, E_TWICE_H0 = 66, EG0 = 67, ER1 = 68, EG1 = 69,
      EH1 = 70, ER2 = 71, EG2 = 72, EH2 = 73, E_REST = 74, ROOT = 75, SLOPE = 76, MIDDLE = 77,
      ROOT_OR_0 = 78, LEFT = 79, RIGHT = 80, EDGE_LEFT = 81, EDGE_RIGHT = 82, OVER_C = 83, M0 = 84,
      M_REST = 85, RIGHT_AT = 86, SLACK = 87, IS_ELLIPSE = 88, BOUNDED = 89;
  localparam [STEPS*32-1:0] PROGRAM = {
    {SUM, A, ONE, C},
    {PRODUCT, A, C, NOTHING},
    {SUM | MINUS_A, B, B, AC},
    {PRODUCT, OPACITY, MOST_LEVEL, NOTHING},
    {PRODUCT, TRACE, TRACE, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, DETERMINANT, NOTHING, NOTHING},
    {EXACT | MINUS_A, DETERMINANT, D0, ONE},
    {EXACT, D0, D_E1, D0},
    {EXACT | MINUS_A, DETERMINANT, D1, ONE},
    {EXACT, D1, D_E2, D1},
    {OUTSIDE, D2, DETERMINANT, NOTHING},
    {PRODUCT, TRACE_2, PER_D, NOTHING},
    {EXACT | MINUS_A, K0, DETERMINANT, TRACE_2},
    {EXACT, K_REST, PER_D, K0},
    {PRODUCT, CONDITION, EPSILON, NOTHING},
    {PRODUCT, NARROW, TWO, NOTHING},
    {SUM, WIDENING, ONE, ONE},
    {OUTSIDE, A, NOTHING, NOTHING},
    {EXACT | MINUS_A, A, A0, ONE},
    {EXACT, A0, A_E1, A0},
    {EXACT | MINUS_A, A, A1, ONE},
    {EXACT, A1, A_E2, A1},
    {OUTSIDE, A2, A, NOTHING},
    {EXACT | MINUS_A, A3, A, ONE},
    {EXACT, A_REST, A3, A3},
    {EXACT | MINUS_C, Z, INVERSE, ONE},
    {SUM, POWER, LN2, LOGARITHM},
    {PRODUCT, R, R, NOTHING},
    {SUM | MINUS_C, R, THIRD, HALF},
    {SUM | MINUS_A, R_2, QUARTER, L1},
    {SUM, L0, ONE, R},
    {SUM, L2, R_2, L3},
    {SUM, LOG, TWO, ROOM},
    {PRODUCT, CUTOFF, WIDE, NOTHING},
    {PRODUCT, WIDE_CUTOFF, C, NOTHING},
    {PRODUCT, UNDER_RATIO, PER_D, NOTHING},
    {EXACT | MINUS_A, W0, DETERMINANT, UNDER_RATIO},
    {EXACT, W_REST, PER_D, W0},
    {PRODUCT, WIDE_CUTOFF, PER_A, NOTHING},
    {SUM | MINUS_C, LINE, ONE, Y},
    {PRODUCT, DETERMINANT, PER_A, NOTHING},
    {PRODUCT, D_PER_A, PER_A, NOTHING},
    {PRODUCT, BEND, DY, NOTHING},
    {SUM | MINUS_A, BEND_DY, DY, RADICAND},
    {OUTSIDE, RATIO, NOTHING, NOTHING},
    {OUTSIDE, RATIO, NOTHING, NOTHING},
    {PRODUCT, RATIO, TWICE_H0, NOTHING},
    {EXACT | MINUS_A, G0, H0, HALF},
    {EXACT, G0, R1, G0},
    {EXACT, H0, R1, H0},
    {EXACT | MINUS_A, G1, H1, HALF},
    {EXACT, G1, R2, G1},
    {EXACT, H1, R2, H1},
    {EXACT | MINUS_A, G2, G2, RATIO},
    {EXACT, REST, H2, G2},
    {OUTSIDE, C, NOTHING, NOTHING},
    {EXACT | MINUS_A, C, C0, ONE},
    {EXACT, C0, C_E1, C0},
    {EXACT | MINUS_A, C, C1, ONE},
    {EXACT, C1, C_E2, C1},
    {OUTSIDE, C2, C, NOTHING},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {PRODUCT, UNDER_ROOT, E_TWICE_H0, NOTHING},
    {EXACT | MINUS_A, EG0, EH0, HALF},
    {EXACT, EG0, ER1, EG0},
    {EXACT, EH0, ER1, EH0},
    {EXACT | MINUS_A, EG1, EH1, HALF},
    {EXACT, EG1, ER2, EG1},
    {EXACT, EH1, ER2, EH1},
    {EXACT | MINUS_A, EG2, EG2, UNDER_ROOT},
    {EXACT, E_REST, EH2, EG2},
    {PRODUCT | MINUS_A, B, PER_A, NOTHING},
    {PRODUCT, SLOPE, DY, NOTHING},
    {OUTSIDE, ROOT, UNDER_ROOT, NOTHING},
    {SUM | MINUS_A, ROOT_OR_0, ONE, MIDDLE},
    {SUM, ROOT_OR_0, ONE, MIDDLE},
    {OUTSIDE, LEFT, UNDER_ROOT, NOTHING},
    {OUTSIDE, RIGHT, UNDER_ROOT, NOTHING},
    {PRODUCT | MINUS_A, B, HALF_WIDTH, NOTHING},
    {PRODUCT, OVER_C, PER_C, NOTHING},
    {EXACT | MINUS_A, M0, C, OVER_C},
    {EXACT, M_REST, PER_C, M0},
    {SUM, HALF_WIDTH, RELATIVE, SLACK_PX},
    {OUTSIDE, A, DETERMINANT, WIDENING},
    {OUTSIDE, IS_ELLIPSE, HALF_WIDTH, NOTHING}
  };
  localparam [CONSTANTS*32-1:0] NUMBERS = {32'h3CA3D70A, 32'h38D1B717, 32'h38D1B717, 32'h3E800000, 32'h3EAAAAAB, 32'h3F317218,
          32'h437F0000, 32'h36800000, 32'h40000000, 32'h80000000, 32'h3F000000, 32'h3F800000};
  localparam [STEPS-1:0] IS_KEPT = 1;
  localparam [STEPS-1:0] KEPT = (IS_KEPT << SLOPE) | (IS_KEPT << RADICAND) | (IS_KEPT << BEND) |
      (IS_KEPT << HALF_WIDTH) | (IS_KEPT << RIGHT_AT) | (IS_KEPT << SLACK) | (IS_KEPT << EDGE_LEFT) |
      (IS_KEPT << EDGE_RIGHT) | (IS_KEPT << BOUNDED);

  // Nothing is made here of the steps of lanes.
  /* verilator lint_off UNDRIVEN */
  /* verilator lint_off UNUSEDSIGNAL */
  wire [STEPS*128-1:0] operands;
  wire [STEPS*32-1:0] outside, kept;
  wire [2:0] set_last_bit;  // of seeds: it is set behind their steps
  /* verilator lint_on UNUSEDSIGNAL */
  /* verilator lint_on UNDRIVEN */
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
      .inputs({line, opacity, conic_c, conic_b, conic_a, y}),
      .operands(operands),
      .outside(outside),
      .kept(kept),
      .ends(ends)
  );
  assign bounded = kept[BOUNDED*32];
  assign begun = {kept[EDGE_RIGHT*32+:32], kept[EDGE_LEFT*32+:32], kept[SLACK*32+:32],
                  kept[RIGHT_AT*32+:32], kept[HALF_WIDTH*32+:32], kept[BEND*32+:32],
                  kept[RADICAND*32+:32], kept[SLOPE*32+:32]};

  logarithm_split level (
      .x(operands[Z*128+:32]),
      .z(outside[Z*32+:32]),
      .power(outside[POWER*32+:32]),
      .inverse(outside[INVERSE*32+:32]),
      .logarithm(outside[LOGARITHM*32+:32])
  );

  // Seeds of quotients, and the last bit that their steps miss.
  reciprocal_seed of_determinant (
      .d(operands[D0*128+:32]),
      .seed(outside[D0*32+:32]),
      .set_last_bit(set_last_bit[0])
  );
  reciprocal_seed of_a (
      .d(operands[A0*128+:32]),
      .seed(outside[A0*32+:32]),
      .set_last_bit(set_last_bit[1])
  );
  reciprocal_seed of_c (
      .d(operands[C0*128+:32]),
      .seed(outside[C0*32+:32]),
      .set_last_bit(set_last_bit[2])
  );
  assign outside[PER_D*32+:32] = operands[PER_D*128+:32] | {31'b0, &operands[PER_D*128+32+:23]};
  assign outside[A3*32+:32] = operands[A3*128+:32] | {31'b0, &operands[A3*128+32+:23]};
  assign outside[PER_C*32+:32] = operands[PER_C*128+:32] | {31'b0, &operands[PER_C*128+32+:23]};

  // Seeds of roots; the root of 0.
  wire [31:0] seed, edge_seed;
  root_seed of_ratio (
      .x(operands[H0*128+16+:15]),
      .seed(seed)
  );
  root_seed of_edge (
      .x(operands[EH0*128+16+:15]),
      .seed(edge_seed)
  );
  assign outside[H0*32+:32] = seed;
  assign outside[EH0*32+:32] = edge_seed;
  assign outside[TWICE_H0*32+:32] = {seed[31], seed[30:23] + 8'd1, seed[22:0]};
  assign outside[E_TWICE_H0*32+:32] = {edge_seed[31], edge_seed[30:23] + 8'd1, edge_seed[22:0]};
  assign outside[ROOT_OR_0*32+:32] =
      operands[ROOT_OR_0*128+:32] & {32{operands[ROOT_OR_0*128+55+:8] != 0}};

  // Edges beside the ellipse are nowhere.
  wire [1:0] touches;
  less_or_equal left_inside (
      .a(32'b0),
      .b(operands[EDGE_LEFT*128+32+:32]),
      .is(touches[0])
  );
  less_or_equal right_inside (
      .a(32'b0),
      .b(operands[EDGE_RIGHT*128+32+:32]),
      .is(touches[1])
  );
  assign outside[EDGE_LEFT*32+:32] = touches[0] ? operands[EDGE_LEFT*128+:32] : EVERYWHERE;
  assign outside[EDGE_RIGHT*32+:32] =
      touches[1] ? operands[EDGE_RIGHT*128+:32] : {1'b1, EVERYWHERE[30:0]};

  // Greater than 0: not less or equal, and a number.
  wire [31:0] a = operands[IS_ELLIPSE*128+:32], determinant = operands[IS_ELLIPSE*128+32+:32];
  wire narrow, finite;
  less_or_equal widened (
      .a(operands[IS_ELLIPSE*128+64+:32]),
      .b(MOST_WIDENING),
      .is(narrow)
  );
  less_or_equal ends_somewhere (
      .a(operands[BOUNDED*128+32+:32]),
      .b(MOST_HALF_WIDTH),
      .is(finite)
  );
  assign outside[IS_ELLIPSE*32+:32] =
      {31'b0, narrow & ~a[31] & a[30:0] != 0 & ~determinant[31] & determinant[30:0] != 0};
  assign outside[BOUNDED*32+:32] = {31'b0, finite & operands[BOUNDED*128]};
endmodule
