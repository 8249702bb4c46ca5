// The lane in half precision: products rounded, zeros without a sign, as HalfScalar has it.
module fp16_lane (
    input clock,
    input [15:0] a,
    input [15:0] b,
    input [15:0] c,
    output [15:0] product,
    output [15:0] sum
);
  lane #(
      .EXPONENT_BITS(5),
      .FRACTION_BITS(10),
      .UNROUNDED(0),
      .SIGNED_ZERO(0),
      .REGISTERS(3'b110)
  ) half (
      .clock(clock),
      .a(a),
      .b(b),
      .c(c),
      .unrounded(1'b0),
      .product(product),
      .sum(sum)
  );
endmodule
