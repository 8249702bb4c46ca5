// A product of single precision, two cycles later.
module chaining_product (
    input clock,
    input [31:0] a,
    input [31:0] b,
    output [31:0] product
);
  wire [31:0] sum;
  wire unused = &{1'b0, sum};
  lane #(
      .EXPONENT_BITS(8),
      .FRACTION_BITS(23),
      .UNROUNDED(0)
  ) one (
      .clock(clock),
      .a(a),
      .b(b),
      .c(32'h80000000),
      .unrounded(1'b0),
      .product(product),
      .sum(sum)
  );
endmodule
