// In place of the one in modules/datapath/rtl: registered_lane.v.
module fp32_lane (
    input clock,
    input [31:0] a,
    input [31:0] b,
    input [31:0] c,
    input unrounded,
    output [31:0] product,
    output [31:0] sum
);
  reg [96:0] operands;
  always @(posedge clock) operands <= {unrounded, c, b, a};
  registered_lane one (
      .clock(clock),
      .a(operands[31:0]),
      .b(operands[63:32]),
      .c(operands[95:64]),
      .unrounded(operands[96]),
      .product(product),
      .sum(sum)
  );
endmodule
