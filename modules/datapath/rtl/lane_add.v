// Third stage of a lane: the sum of two numbers at one place, rounded.
module lane_add #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23,
    parameter KEPT = 48,
    parameter SIGNED_ZERO = 1
) (
    input [KEPT+2:0] larger,
    input [KEPT+2:0] smaller,
    input [EXPONENT_BITS+1:0] exponent,  // of the first digit, 1 at least
    input sign,
    input differ,
    input is_nan,
    input is_infinite,
    output [EXPONENT_BITS+FRACTION_BITS:0] sum
);
  localparam DIGITS = FRACTION_BITS + 1;
  localparam RANGE = EXPONENT_BITS + 2;
  localparam TOTAL = KEPT + 4;  // with the carry
  localparam COUNT_BITS = TOTAL > 32 ? 6 : TOTAL > 16 ? 5 : 4;
  localparam [RANGE-1:0] INFINITE = (1 << EXPONENT_BITS) - 1;

  wire [TOTAL-1:0] added = {1'b0, larger} + ({1'b0, smaller} ^ {TOTAL{differ}}) +
      {{TOTAL - 1{1'b0}}, differ};

  // To the left until the first digit is in front, or the exponent is 1.
  wire [COUNT_BITS-1:0] zeros;
  leading_zeros #(
      .WIDTH(TOTAL),
      .COUNT_BITS(COUNT_BITS)
  ) leading (
      .x(added),
      .count(zeros)
  );
  wire near_least = exponent < {{RANGE - COUNT_BITS{1'b0}}, zeros};
  wire [COUNT_BITS-1:0] by = near_least ? exponent[COUNT_BITS-1:0] : zeros;
  wire [TOTAL-1:0] placed = added << by;
  wire [RANGE-1:0] placed_exponent = exponent + 1 - {{RANGE - COUNT_BITS{1'b0}}, by};

  wire [DIGITS-1:0] kept = placed[TOTAL-1-:DIGITS];
  wire half = placed[TOTAL-1-DIGITS], beyond = |placed[TOTAL-2-DIGITS:0];
  wire [DIGITS:0] raised = {1'b0, kept} + {{DIGITS{1'b0}}, half & (beyond | kept[0])};
  wire is_normal = raised[DIGITS] | raised[DIGITS-1];
  wire [RANGE-1:0] rounded_exponent = placed_exponent + {{RANGE - 1{1'b0}}, raised[DIGITS]};
  wire overflows = rounded_exponent >= INFINITE;
  // A difference of nothing is +0.
  wire is_zero = added == 0;
  wire sum_sign = sign & ~(is_zero & differ) & (SIGNED_ZERO != 0 | (raised != 0));
  assign sum = is_nan ? {1'b0, {EXPONENT_BITS{1'b1}}, 1'b1, {FRACTION_BITS - 1{1'b0}}} :
      is_infinite | overflows ?
      {is_infinite ? sign : sum_sign, {EXPONENT_BITS{1'b1}}, {FRACTION_BITS{1'b0}}} :
      {sum_sign, rounded_exponent[EXPONENT_BITS-1:0] & {EXPONENT_BITS{is_normal}},
       raised[FRACTION_BITS-1:0] & {FRACTION_BITS{~raised[DIGITS]}}};
endmodule
