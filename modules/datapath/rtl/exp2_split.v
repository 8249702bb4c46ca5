// The beginning of 2^t: t is so many steps of 1/64, to the nearest, ties to even, and a rest of at
// most 1/128. Its rest is a number again (algorithm/splat/exp2.h). |t| < 128, or no number.
module exp2_split #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23
) (
    input [EXPONENT_BITS+FRACTION_BITS:0] t,
    output [EXPONENT_BITS+FRACTION_BITS:0] rest,
    output [5:0] row,     // steps within a whole
    output [7:0] whole    // two's complement; 0 where t is no number
);
  localparam DIGITS = FRACTION_BITS + 1;
  localparam COUNT_BITS = DIGITS > 16 ? 5 : 4;
  localparam STEP_BITS = 14;  // of a signed count of steps
  localparam [EXPONENT_BITS-1:0] BIAS = (1 << (EXPONENT_BITS - 1)) - 1;
  localparam [EXPONENT_BITS-1:0] LEAST = BIAS - 7;  // of 1/128
  localparam [EXPONENT_BITS-1:0] MOST = BIAS + 6;   // of 64

  wire sign = t[EXPONENT_BITS+FRACTION_BITS];
  wire [EXPONENT_BITS-1:0] field = t[FRACTION_BITS+:EXPONENT_BITS];
  wire is_special = &field;
  wire is_small = field < LEAST;  // all of it is the rest

  // Steps before the point, the rest behind it: DIGITS places are enough.
  wire [3:0] by = MOST[3:0] - field[3:0];
  wire [STEP_BITS-2+DIGITS:0] fixed =
      {1'b1, t[FRACTION_BITS-1:0], {STEP_BITS - 1{1'b0}}} >> by;
  wire [STEP_BITS-2:0] steps = fixed[STEP_BITS-2+DIGITS:DIGITS];
  wire [DIGITS-1:0] behind = fixed[DIGITS-1:0];
  wire up = behind[DIGITS-1] & (steps[0] | (behind[DIGITS-2:0] != 0));
  wire [STEP_BITS-2:0] nearest = steps + {{STEP_BITS - 2{1'b0}}, up};
  wire [STEP_BITS-1:0] signed_steps = sign ? -{1'b0, nearest} : {1'b0, nearest};
  assign row = is_small | is_special ? 6'b0 : signed_steps[5:0];
  assign whole = is_small | is_special ? 8'b0 : signed_steps[13:6];

  // Back to a number.
  wire [DIGITS-1:0] distance = up ? -behind : behind;
  wire [COUNT_BITS-1:0] zeros;
  leading_zeros #(
      .WIDTH(DIGITS),
      .COUNT_BITS(COUNT_BITS)
  ) leading (
      .x(distance),
      .count(zeros)
  );
  // The first place behind the point is 1/128. A half may become subnormal.
  wire is_subnormal = LEAST <= {{EXPONENT_BITS - COUNT_BITS{1'b0}}, zeros};
  wire [COUNT_BITS-1:0] left = is_subnormal ? LEAST[COUNT_BITS-1:0] - 1'b1 : zeros;
  wire [FRACTION_BITS-1:0] placed = distance[FRACTION_BITS-1:0] << left;
  wire [EXPONENT_BITS-1:0] exponent = LEAST - {{EXPONENT_BITS - COUNT_BITS{1'b0}}, zeros};
  assign rest = is_small | is_special ? t :
      distance == 0 ? {1 + EXPONENT_BITS + FRACTION_BITS{1'b0}} :
      {sign ^ up, is_subnormal ? {EXPONENT_BITS{1'b0}} : exponent, placed};
endmodule
