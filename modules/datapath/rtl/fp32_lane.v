// The lane in single precision, with both kinds of product.
module fp32_lane (
    input clock,
    input [31:0] a,
    input [31:0] b,
    input [31:0] c,
    input unrounded,
    output [31:0] product,
    output [31:0] sum
);
  lane #(
      .EXPONENT_BITS(8),
      .FRACTION_BITS(23),
      .UNROUNDED(1),
      .SIGNED_ZERO(1),
      .REGISTERS(3'b111)
  ) single (
      .clock(clock),
      .a(a),
      .b(b),
      .c(c),
      .unrounded(unrounded),
      .product(product),
      .sum(sum)
  );
endmodule
