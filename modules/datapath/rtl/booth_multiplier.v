// The product of two unsigned numbers, whole: rows of Booth's recoding to the base of 4, added by a
// tree of carry-save adders, which synthesis makes of the sum.
module booth_multiplier #(
    parameter WIDTH = 24  // even
) (
    input [WIDTH-1:0] a,
    input [WIDTH-1:0] b,
    output reg [2*WIDTH-1:0] product
);
  localparam ROWS = WIDTH / 2 + 1;

  // Row i is a times -2, -1, 0, 1 or 2, in ones' complement where it is negative: its last one comes
  // with `negative`. Instead of the sign's copies each row has the inverted sign and a constant.
  wire [WIDTH+2:0] recoded = {2'b00, b, 1'b0};
  reg [2:0] digit;
  reg once, twice, negative;
  reg [WIDTH:0] row;
  integer i;
  always @* begin
    product = 0;
    for (i = 0; i < ROWS; i = i + 1) begin
      digit = recoded[2*i+:3];
      once = digit[1] ^ digit[0];
      twice = (digit == 3'b011) | (digit == 3'b100);
      negative = digit[2] & ~(digit[1] & digit[0]);
      row = ({WIDTH + 1{once}} & {1'b0, a} | {WIDTH + 1{twice}} & {a, 1'b0}) ^
          {WIDTH + 1{negative}};
      product = product + ({{WIDTH - 2{1'b0}}, ~negative, row} << (2 * i));
      product = product + ({{2 * WIDTH - 1{1'b0}}, negative} << (2 * i));
    end
    // The constants: -2^(WIDTH + 1 + 2 i) of every row.
    for (i = 0; i < ROWS; i = i + 1) product = product - ({{2*WIDTH-1{1'b0}}, 1'b1} << (WIDTH + 1 + 2 * i));
  end
endmodule
