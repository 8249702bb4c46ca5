// Moved to the right; the last place holds the or of itself and of all that left.
module shift_right_sticky #(
    parameter WIDTH = 27,
    parameter SHIFT_BITS = 5
) (
    input [WIDTH-1:0] x,
    input [SHIFT_BITS-1:0] by,
    output reg [WIDTH-1:0] moved
);
  reg lost;
  integer level, i;
  reg [WIDTH-1:0] passed;
  always @* begin
    passed = x;
    lost = 1'b0;
    for (level = 0; level < SHIFT_BITS; level = level + 1) begin
      if (by[level]) begin
        for (i = 0; i < WIDTH && i < (1 << level); i = i + 1) lost = lost | passed[i];
        passed = passed >> (1 << level);
      end
    end
    moved = {passed[WIDTH-1:1], passed[0] | lost};
  end
endmodule
