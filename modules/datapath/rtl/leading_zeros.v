// How many zeros stand before the first one; 2^COUNT_BITS - 1 or more bits of zeros count as that.
module leading_zeros #(
    parameter WIDTH = 24,
    parameter COUNT_BITS = 5  // 2^COUNT_BITS >= WIDTH
) (
    input [WIDTH-1:0] x,
    output reg [COUNT_BITS-1:0] count
);
  localparam POSITIONS = 1 << COUNT_BITS;

  // Blocks of 2^level places, the first in place 0: whether one has no one, and zeros before it.
  reg [POSITIONS-1:0] empty;
  reg [POSITIONS*COUNT_BITS-1:0] zeros;
  integer level, i;
  always @* begin
    for (i = 0; i < POSITIONS; i = i + 1) empty[i] = i < WIDTH ? ~x[i<WIDTH?WIDTH-1-i : 0] : 1'b1;
    zeros = 0;
    for (level = 0; level < COUNT_BITS; level = level + 1) begin
      for (i = 0; i < POSITIONS >> (level + 1); i = i + 1) begin
        zeros[i*COUNT_BITS+:COUNT_BITS] = empty[2*i] ? zeros[(2*i+1)*COUNT_BITS+:COUNT_BITS] :
            zeros[2*i*COUNT_BITS+:COUNT_BITS];
        zeros[i*COUNT_BITS+level] = empty[2*i];
        empty[i] = empty[2*i] & empty[2*i+1];
      end
    end
    count = zeros[COUNT_BITS-1:0];
  end
endmodule
