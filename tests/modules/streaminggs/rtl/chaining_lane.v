// In place of the one in modules/streaminggs/rendering/rtl: registered_lane.v.
module chaining_lane (
    input clock,
    input [95:0] operands,
    output [31:0] product,
    output [31:0] sum
);
  reg [95:0] held;
  always @(posedge clock) held <= operands;
  registered_lane one (
      .clock(clock),
      .a(held[31:0]),
      .b(held[63:32]),
      .c(held[95:64]),
      .unrounded(1'b0),
      .product(product),
      .sum(sum)
  );
endmodule
