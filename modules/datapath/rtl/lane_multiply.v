// First stage of a lane: the digits of the product, and how far they are from a number's place.
// Value: digits 2^(exponent - bias - (2 DIGITS - 1)) where exponent is biased; the first digit gets
// into its place by `shift` to the left, if the exponent allows that.
module lane_multiply #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23
) (
    input [EXPONENT_BITS+FRACTION_BITS:0] a,
    input [EXPONENT_BITS+FRACTION_BITS:0] b,
    output [2*FRACTION_BITS+1:0] digits,
    output [EXPONENT_BITS+1:0] exponent,  // two's complement
    output [EXPONENT_BITS+1:0] shift,     // to the left; negative: to the right
    output sign,
    output is_nan,
    output is_infinite
);
  localparam DIGITS = FRACTION_BITS + 1;
  localparam RANGE = EXPONENT_BITS + 2;
  localparam COUNT_BITS = DIGITS > 16 ? 5 : 4;
  localparam [RANGE-1:0] BIAS_LESS_ONE = (1 << (EXPONENT_BITS - 1)) - 2;

  wire [EXPONENT_BITS-1:0] a_field = a[FRACTION_BITS+:EXPONENT_BITS];
  wire [EXPONENT_BITS-1:0] b_field = b[FRACTION_BITS+:EXPONENT_BITS];
  wire [DIGITS-1:0] a_digits = {a_field != 0, a[FRACTION_BITS-1:0]};
  wire [DIGITS-1:0] b_digits = {b_field != 0, b[FRACTION_BITS-1:0]};
  wire a_zero = a_digits == 0, b_zero = b_digits == 0;
  wire a_special = &a_field, b_special = &b_field;
  wire a_nan = a_special & (a[FRACTION_BITS-1:0] != 0);
  wire b_nan = b_special & (b[FRACTION_BITS-1:0] != 0);

  assign sign = a[EXPONENT_BITS+FRACTION_BITS] ^ b[EXPONENT_BITS+FRACTION_BITS];
  assign is_nan = a_nan | b_nan | (a_special & b_zero) | (b_special & a_zero);
  assign is_infinite = a_special | b_special;

  booth_multiplier #(
      .WIDTH(DIGITS)
  ) multiplier (
      .a(a_digits),
      .b(b_digits),
      .product(digits)
  );

  // A subnormal number has zeros in front, and the exponent of the least normal one.
  wire [COUNT_BITS-1:0] a_zeros, b_zeros;
  leading_zeros #(
      .WIDTH(DIGITS),
      .COUNT_BITS(COUNT_BITS)
  ) a_leading (
      .x(a_digits),
      .count(a_zeros)
  );
  leading_zeros #(
      .WIDTH(DIGITS),
      .COUNT_BITS(COUNT_BITS)
  ) b_leading (
      .x(b_digits),
      .count(b_zeros)
  );
  wire [RANGE-1:0] a_exponent = {2'b00, a_field} | {{RANGE - 1{1'b0}}, a_field == 0};
  wire [RANGE-1:0] b_exponent = {2'b00, b_field} | {{RANGE - 1{1'b0}}, b_field == 0};
  wire [RANGE-1:0] zeros = {{RANGE - COUNT_BITS{1'b0}}, a_zeros} +
      {{RANGE - COUNT_BITS{1'b0}}, b_zeros};
  wire [RANGE-1:0] room = a_exponent + b_exponent - BIAS_LESS_ONE - 1;
  assign exponent = room + 1;
  // Of a product of zero the exponent is 1, too.
  assign shift = a_zero | b_zero | ($signed(room) < $signed(zeros)) ? room : zeros;
endmodule
