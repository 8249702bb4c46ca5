// The lane in single precision with its first register in front of the multiplier, in place of behind it:
// the same in every cycle. So nothing passes through it at once, and Verilator compiles it once for all.
module registered_lane (
    input clock,
    input [31:0] a,  // from a register
    input [31:0] b,
    input [31:0] c,
    input unrounded,
    output [31:0] product,
    output [31:0] sum
);
  /* verilator hier_block */
  lane #(
      .REGISTERS(3'b110)
  ) one (
      .clock(clock),
      .a(a),
      .b(b),
      .c(c),
      .unrounded(unrounded),
      .product(product),
      .sum(sum)
  );
endmodule
