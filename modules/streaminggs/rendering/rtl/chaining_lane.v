// A lane in single precision that only chains.
module chaining_lane (
    input clock,
    input [95:0] operands,  // a, b, c, a the lowest
    output [31:0] product,
    output [31:0] sum
);
  lane #(
      .EXPONENT_BITS(8),
      .FRACTION_BITS(23),
      .UNROUNDED(0)
  ) one (
      .clock(clock),
      .a(operands[31:0]),
      .b(operands[63:32]),
      .c(operands[95:64]),
      .unrounded(1'b0),
      .product(product),
      .sum(sum)
  );
endmodule
