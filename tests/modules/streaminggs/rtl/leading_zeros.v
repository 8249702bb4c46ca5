// Stands for leading_zeros.v of modules/datapath/rtl, of which Verilator makes a page of C++ in each
// place.
module leading_zeros #(
    parameter WIDTH = 24,
    parameter COUNT_BITS = 5
) (
    input [WIDTH-1:0] x,
    output reg [COUNT_BITS-1:0] count
);
  localparam POSITIONS = 1 << COUNT_BITS;
  reg [POSITIONS-1:0] rest;
  integer level;
  always @* begin
    rest = {{POSITIONS - WIDTH{1'b0}}, x} << (POSITIONS - WIDTH);
    for (level = COUNT_BITS - 1; level >= 0; level = level - 1) begin
      count[level] = rest >> (POSITIONS - (1 << level)) == 0;
      if (count[level]) rest = rest << (1 << level);
    end
  end
endmodule
