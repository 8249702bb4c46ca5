// A lane: a multiplier followed by an adder, one multiply-add a cycle. IEEE 754 with subnormals,
// rounded to nearest, ties to even; every NaN is one quiet NaN.
//   unrounded = 0: sum = round(round(a b) + c), product = round(a b), as the source computes
//   unrounded = 1: sum = round(a b + c), as quotients and roots need; only where UNROUNDED is 1
// Timing: registers stand behind the stages of REGISTERS; with all three the product is there two
// cycles after a, b and c, and the sum three.
module lane #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23,
    parameter UNROUNDED = 1,    // 0: a lane that only chains
    parameter SIGNED_ZERO = 1,  // 0: a result of zero is +0
    parameter [2:0] REGISTERS = 3'b111  // behind multiply, align, add, from bit 0
) (
    input clock,
    input [EXPONENT_BITS+FRACTION_BITS:0] a,
    input [EXPONENT_BITS+FRACTION_BITS:0] b,
    input [EXPONENT_BITS+FRACTION_BITS:0] c,
    input unrounded,
    output [EXPONENT_BITS+FRACTION_BITS:0] product,
    output [EXPONENT_BITS+FRACTION_BITS:0] sum
);
  localparam WIDTH = 1 + EXPONENT_BITS + FRACTION_BITS;
  localparam DIGITS = FRACTION_BITS + 1;
  localparam RANGE = EXPONENT_BITS + 2;  // bits of a signed exponent
  localparam KEPT = UNROUNDED != 0 ? 2 * DIGITS : DIGITS;  // digits of a product that are added to

  // Multiply.
  wire [2*DIGITS-1:0] digits, digits_1;
  wire [RANGE-1:0] exponent, exponent_1, shift, shift_1;
  wire sign, sign_1, is_nan, is_nan_1, is_infinite, is_infinite_1, unrounded_1;
  wire [WIDTH-1:0] c_1;
  lane_multiply #(
      .EXPONENT_BITS(EXPONENT_BITS),
      .FRACTION_BITS(FRACTION_BITS)
  ) multiply (
      .a(a),
      .b(b),
      .digits(digits),
      .exponent(exponent),
      .shift(shift),
      .sign(sign),
      .is_nan(is_nan),
      .is_infinite(is_infinite)
  );
  stage #(
      .WIDTH(2 * DIGITS + 2 * RANGE + WIDTH + 4),
      .REGISTERED(REGISTERS[0])
  ) multiplied (
      .clock(clock),
      .d({digits, exponent, shift, sign, is_nan, is_infinite, c, unrounded}),
      .q({digits_1, exponent_1, shift_1, sign_1, is_nan_1, is_infinite_1, c_1, unrounded_1})
  );

  // Round the product, align.
  wire [WIDTH-1:0] product_1;
  wire [KEPT+2:0] larger, larger_2, smaller, smaller_2;
  wire [RANGE-1:0] larger_exponent, larger_exponent_2;
  wire sum_sign, sum_sign_2, differ, differ_2, sum_nan, sum_nan_2, sum_infinite, sum_infinite_2;
  lane_align #(
      .EXPONENT_BITS(EXPONENT_BITS),
      .FRACTION_BITS(FRACTION_BITS),
      .UNROUNDED(UNROUNDED),
      .SIGNED_ZERO(SIGNED_ZERO)
  ) align (
      .digits(digits_1),
      .exponent(exponent_1),
      .shift(shift_1),
      .sign(sign_1),
      .is_nan(is_nan_1),
      .is_infinite(is_infinite_1),
      .c(c_1),
      .unrounded(unrounded_1),
      .product(product_1),
      .larger(larger),
      .smaller(smaller),
      .larger_exponent(larger_exponent),
      .sum_sign(sum_sign),
      .differ(differ),
      .sum_nan(sum_nan),
      .sum_infinite(sum_infinite)
  );
  stage #(
      .WIDTH(WIDTH + 2 * (KEPT + 3) + RANGE + 4),
      .REGISTERED(REGISTERS[1])
  ) aligned (
      .clock(clock),
      .d({product_1, larger, smaller, larger_exponent, sum_sign, differ, sum_nan, sum_infinite}),
      .q({product, larger_2, smaller_2, larger_exponent_2, sum_sign_2, differ_2, sum_nan_2,
          sum_infinite_2})
  );

  // Add, round.
  wire [WIDTH-1:0] sum_2;
  lane_add #(
      .EXPONENT_BITS(EXPONENT_BITS),
      .FRACTION_BITS(FRACTION_BITS),
      .KEPT(KEPT),
      .SIGNED_ZERO(SIGNED_ZERO)
  ) add (
      .larger(larger_2),
      .smaller(smaller_2),
      .exponent(larger_exponent_2),
      .sign(sum_sign_2),
      .differ(differ_2),
      .is_nan(sum_nan_2),
      .is_infinite(sum_infinite_2),
      .sum(sum_2)
  );
  stage #(
      .WIDTH(WIDTH),
      .REGISTERED(REGISTERS[2])
  ) added (
      .clock(clock),
      .d(sum_2),
      .q(sum)
  );
endmodule
