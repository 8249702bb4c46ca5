// Second stage of a lane: the product in its place and rounded, then the smaller of product and
// addend moved to the place of the larger.
module lane_align #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23,
    parameter UNROUNDED = 1,
    parameter SIGNED_ZERO = 1,
    parameter KEPT = UNROUNDED != 0 ? 2 * FRACTION_BITS + 2 : FRACTION_BITS + 1
) (
    input [2*FRACTION_BITS+1:0] digits,
    input [EXPONENT_BITS+1:0] exponent,
    input [EXPONENT_BITS+1:0] shift,
    input sign,
    input is_nan,
    input is_infinite,
    input [EXPONENT_BITS+FRACTION_BITS:0] c,
    input unrounded,
    output [EXPONENT_BITS+FRACTION_BITS:0] product,
    output [KEPT+2:0] larger,  // three places behind the digits: of the last all beyond is the or
    output [KEPT+2:0] smaller,
    output [EXPONENT_BITS+1:0] larger_exponent,
    output sum_sign,
    output differ,  // signs of product and addend
    output sum_nan,
    output sum_infinite
);
  localparam WIDTH = 1 + EXPONENT_BITS + FRACTION_BITS;
  localparam DIGITS = FRACTION_BITS + 1;
  localparam RANGE = EXPONENT_BITS + 2;
  localparam SHIFT_BITS = DIGITS > 16 ? 6 : 5;  // as many as the digits of a product
  localparam [RANGE-1:0] INFINITE = (1 << EXPONENT_BITS) - 1;
  localparam [RANGE-1:0] FARTHEST = (1 << SHIFT_BITS) - 1;

  // Into its place: one further where the digits' product has one digit less. The exponent is 1 at
  // least: a subnormal number has zeros in front.
  wire to_right = shift[RANGE-1];
  wire [RANGE-1:0] right = -shift;
  wire [SHIFT_BITS-1:0] right_by = right > FARTHEST ? FARTHEST[SHIFT_BITS-1:0] : right[SHIFT_BITS-1:0];
  wire [2*DIGITS:0] moved_right;
  shift_right_sticky #(
      .WIDTH(2 * DIGITS + 1),
      .SHIFT_BITS(SHIFT_BITS)
  ) below (
      .x({digits, 1'b0}),
      .by(right_by),
      .moved(moved_right)
  );
  wire [2*DIGITS-1:0] moved_left = digits << shift[SHIFT_BITS-1:0];
  wire [RANGE-1:0] exponent_left = exponent - shift;
  wire one_more = ~moved_left[2*DIGITS-1] & (exponent_left != 1);
  wire [2*DIGITS:0] placed = to_right ? moved_right :
      one_more ? {moved_left[2*DIGITS-2:0], 2'b00} : {moved_left, 1'b0};
  wire [RANGE-1:0] placed_exponent =
      to_right ? {{RANGE - 1{1'b0}}, 1'b1} : exponent_left - {{RANGE - 1{1'b0}}, one_more};

  // Rounded.
  wire [DIGITS-1:0] kept = placed[2*DIGITS-:DIGITS];
  wire half = placed[DIGITS], beyond = |placed[DIGITS-1:0];
  wire [DIGITS:0] raised = {1'b0, kept} + {{DIGITS{1'b0}}, half & (beyond | kept[0])};
  wire [DIGITS-1:0] rounded = raised[DIGITS] ? {1'b1, {DIGITS - 1{1'b0}}} : raised[DIGITS-1:0];
  wire [RANGE-1:0] rounded_exponent = placed_exponent + {{RANGE - 1{1'b0}}, raised[DIGITS]};
  wire overflows = ~rounded_exponent[RANGE-1] & (rounded_exponent >= INFINITE);
  wire rounded_zero = rounded == 0;
  wire product_sign = sign & (SIGNED_ZERO != 0 | ~rounded_zero | is_infinite);
  wire product_infinite = is_infinite | overflows;
  assign product = is_nan ? {1'b0, {EXPONENT_BITS{1'b1}}, 1'b1, {FRACTION_BITS - 1{1'b0}}} :
      product_infinite ? {sign, {EXPONENT_BITS{1'b1}}, {FRACTION_BITS{1'b0}}} :
      {product_sign, rounded_exponent[EXPONENT_BITS-1:0] & {EXPONENT_BITS{rounded[DIGITS-1]}},
       rounded[FRACTION_BITS-1:0]};

  // What is added: the rounded digits or all, each with three places behind them.
  wire use_all = UNROUNDED != 0 & unrounded;
  wire [KEPT+2:0] x;
  generate
    if (UNROUNDED != 0) begin : all_digits
      assign x = use_all ? {placed[2*DIGITS:1], 2'b00, placed[0]} : {rounded, {DIGITS + 3{1'b0}}};
    end else begin : rounded_digits
      assign x = {rounded, 3'b000};
    end
  endgenerate
  wire [RANGE-1:0] x_exponent = use_all ? placed_exponent : rounded_exponent;
  wire x_infinite = is_infinite | (overflows & ~use_all);
  wire x_sign = use_all ? sign : product_sign;

  wire [EXPONENT_BITS-1:0] c_field = c[FRACTION_BITS+:EXPONENT_BITS];
  wire c_sign = c[WIDTH-1];
  wire c_special = &c_field;
  wire c_nan = c_special & (c[FRACTION_BITS-1:0] != 0);
  wire [KEPT+2:0] y = {c_field != 0, c[FRACTION_BITS-1:0], {KEPT + 3 - DIGITS{1'b0}}};
  wire [RANGE-1:0] y_exponent = {2'b00, c_field} | {{RANGE - 1{1'b0}}, c_field == 0};

  // The larger first.
  wire [RANGE-1:0] x_above = x_exponent - y_exponent, y_above = y_exponent - x_exponent;
  wire x_is_larger = x_exponent == y_exponent ? x >= y : ~x_above[RANGE-1];
  wire [RANGE-1:0] apart = x_is_larger ? x_above : y_above;
  wire [SHIFT_BITS-1:0] apart_by = apart > FARTHEST ? FARTHEST[SHIFT_BITS-1:0] : apart[SHIFT_BITS-1:0];
  assign larger = x_is_larger ? x : y;
  shift_right_sticky #(
      .WIDTH(KEPT + 3),
      .SHIFT_BITS(SHIFT_BITS)
  ) to_larger (
      .x(x_is_larger ? y : x),
      .by(apart_by),
      .moved(smaller)
  );
  assign larger_exponent = x_is_larger ? x_exponent : y_exponent;
  assign differ = x_sign ^ c_sign;
  assign sum_nan = is_nan | c_nan | (x_infinite & c_special & differ);
  assign sum_infinite = x_infinite | c_special;
  assign sum_sign = x_infinite ? x_sign : c_special ? c_sign : x_is_larger ? x_sign : c_sign;
endmodule
