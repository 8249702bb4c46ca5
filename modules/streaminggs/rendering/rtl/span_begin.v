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

  localparam [7:0] SUM = 8'h00, EXACT = 8'h20, PRODUCT = 8'h40, OUTSIDE = 8'h80, HANDED = 8'hC0,
      MINUS_A = 8'h10, MINUS_C = 8'h08;
  localparam STEPS = 90, INPUTS = 6, CONSTANTS = 12;
  localparam [7:0] Y = 128, A = 129, B = 130, C = 131, OPACITY = 132, LINE = 133;
  localparam [7:0] ONE = 192, HALF = 193, NOTHING = 194, TWO = 195, EPSILON = 196, MOST_LEVEL = 197,
      LN2 = 198, THIRD = 199, QUARTER = 200, ROOM = 201, RELATIVE = 202, SLACK_PX = 203;
  localparam [7:0] LEVEL = 0, INVERSE = 1, A0 = 2, A_E1 = 3, LOGARITHM = 4, Z = 5, R = 6, R_2 = 7,
      AC = 8, DETERMINANT = 9, L1 = 10, L2 = 11, POWER = 12, D0 = 13, D_E1 = 14, D1 = 15, D_E2 = 16,
      D2 = 17, PER_D = 18, A1 = 19, L0 = 20, L3 = 21, LOG = 22, A_E2 = 23, A2 = 24, C0 = 25,
      TRACE = 26, TRACE_2 = 27, C_E1 = 28, C1 = 29, C_E2 = 30, C2 = 31, PER_C = 32, DY = 33,
      K0 = 34, K_REST = 35, CONDITION = 36, NARROW = 37, WIDE = 38, WIDENING = 39, IS_ELLIPSE = 40,
      CUTOFF = 41, WIDE_CUTOFF = 42, UNDER_RATIO = 43, W0 = 44, W_REST = 45, RATIO = 46,
      TWICE_H0 = 47, H0 = 48, G0 = 49, R1 = 50, G1 = 51, H1 = 52, R2 = 53, G2 = 54, REST = 55,
      H2 = 56, HALF_WIDTH = 57, BOUNDED = 58, SLACK = 59, OVER_C = 60, M0 = 61, M_REST = 62,
      RIGHT_AT = 63, A3 = 64, A_REST = 65, PER_A = 66, RADICAND = 67, D_PER_A = 68, BEND = 69,
      BEND_DY = 70, UNDER_ROOT = 71, E_TWICE_H0 = 72, EG0 = 73, SLOPE = 74, MIDDLE = 75, EH0 = 76,
      ER1 = 77, EH1 = 78, EG1 = 79, ER2 = 80, EH2 = 81, EG2 = 82, E_REST = 83, ROOT = 84,
      ROOT_OR_0 = 85, LEFT = 86, EDGE_LEFT = 87, RIGHT = 88, EDGE_RIGHT = 89;
  localparam [STEPS*32-1:0] PROGRAM = {
    {PRODUCT, OPACITY, MOST_LEVEL, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, A, NOTHING, NOTHING},
    {EXACT | MINUS_A, A, A0, ONE},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {EXACT | MINUS_C, Z, INVERSE, ONE},
    {PRODUCT, R, R, NOTHING},
    {PRODUCT, A, C, NOTHING},
    {SUM | MINUS_A, B, B, AC},
    {SUM | MINUS_C, R, THIRD, HALF},
    {SUM | MINUS_A, R_2, QUARTER, L1},
    {OUTSIDE, LEVEL, NOTHING, NOTHING},
    {OUTSIDE, DETERMINANT, NOTHING, NOTHING},
    {EXACT | MINUS_A, DETERMINANT, D0, ONE},
    {EXACT, D0, D_E1, D0},
    {EXACT | MINUS_A, DETERMINANT, D1, ONE},
    {EXACT, D1, D_E2, D1},
    {OUTSIDE, D2, DETERMINANT, NOTHING},
    {EXACT, A0, A_E1, A0},
    {SUM, POWER, LN2, LOGARITHM},
    {SUM, L0, ONE, R},
    {SUM, L2, R_2, L3},
    {EXACT | MINUS_A, A, A1, ONE},
    {EXACT, A1, A_E2, A1},
    {OUTSIDE, C, NOTHING, NOTHING},
    {SUM, A, ONE, C},
    {PRODUCT, TRACE, TRACE, NOTHING},
    {EXACT | MINUS_A, C, C0, ONE},
    {EXACT, C0, C_E1, C0},
    {EXACT | MINUS_A, C, C1, ONE},
    {EXACT, C1, C_E2, C1},
    {OUTSIDE, C2, C, NOTHING},
    {SUM | MINUS_C, LINE, ONE, Y},
    {PRODUCT, TRACE_2, PER_D, NOTHING},
    {EXACT | MINUS_A, K0, DETERMINANT, TRACE_2},
    {EXACT, K_REST, PER_D, K0},
    {PRODUCT, CONDITION, EPSILON, NOTHING},
    {SUM, NARROW, TWO, ONE},
    {HANDED, WIDE, NOTHING, NOTHING},
    {OUTSIDE, A, DETERMINANT, WIDENING},
    {SUM, LOG, TWO, ROOM},
    {PRODUCT, CUTOFF, WIDE, NOTHING},
    {PRODUCT, WIDE_CUTOFF, C, NOTHING},
    {PRODUCT, UNDER_RATIO, PER_D, NOTHING},
    {EXACT | MINUS_A, W0, DETERMINANT, UNDER_RATIO},
    {EXACT, W_REST, PER_D, W0},
    {OUTSIDE, RATIO, NOTHING, NOTHING},
    {OUTSIDE, RATIO, NOTHING, NOTHING},
    {PRODUCT, RATIO, TWICE_H0, NOTHING},
    {EXACT | MINUS_A, G0, H0, HALF},
    {EXACT, G0, R1, G0},
    {EXACT, H0, R1, H0},
    {EXACT | MINUS_A, G1, H1, HALF},
    {EXACT, G1, R2, G1},
    {EXACT | MINUS_A, G2, G2, RATIO},
    {EXACT, H1, R2, H1},
    {EXACT, REST, H2, G2},
    {OUTSIDE, IS_ELLIPSE, HALF_WIDTH, NOTHING},
    {SUM, HALF_WIDTH, RELATIVE, SLACK_PX},
    {PRODUCT | MINUS_A, B, HALF_WIDTH, NOTHING},
    {PRODUCT, OVER_C, PER_C, NOTHING},
    {EXACT | MINUS_A, M0, C, OVER_C},
    {EXACT, M_REST, PER_C, M0},
    {OUTSIDE, A2, A, NOTHING},
    {EXACT | MINUS_A, A3, A, ONE},
    {EXACT, A_REST, A3, A3},
    {PRODUCT, WIDE_CUTOFF, PER_A, NOTHING},
    {PRODUCT, DETERMINANT, PER_A, NOTHING},
    {PRODUCT, D_PER_A, PER_A, NOTHING},
    {PRODUCT, BEND, DY, NOTHING},
    {SUM | MINUS_A, BEND_DY, DY, RADICAND},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {PRODUCT, UNDER_ROOT, E_TWICE_H0, NOTHING},
    {PRODUCT | MINUS_A, B, PER_A, NOTHING},
    {PRODUCT, SLOPE, DY, NOTHING},
    {OUTSIDE, UNDER_ROOT, NOTHING, NOTHING},
    {EXACT | MINUS_A, EG0, EH0, HALF},
    {EXACT, EH0, ER1, EH0},
    {EXACT, EG0, ER1, EG0},
    {EXACT | MINUS_A, EG1, EH1, HALF},
    {EXACT, EH1, ER2, EH1},
    {EXACT, EG1, ER2, EG1},
    {EXACT | MINUS_A, EG2, EG2, UNDER_ROOT},
    {EXACT, E_REST, EH2, EG2},
    {OUTSIDE, ROOT, UNDER_ROOT, NOTHING},
    {SUM | MINUS_A, ROOT_OR_0, ONE, MIDDLE},
    {OUTSIDE, LEFT, UNDER_ROOT, NOTHING},
    {SUM, ROOT_OR_0, ONE, MIDDLE},
    {OUTSIDE, RIGHT, UNDER_ROOT, NOTHING}
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
