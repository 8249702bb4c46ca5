// What the root of a normal number starts from: half its inverse root, to 8 bits, in the middle of
// the row that the exponent's last bit and the first 7 digits of the fraction pick.
module root_seed (
    input [14:0] x,  // positive: its exponent and the first 7 digits of its fraction
    output [31:0] seed
);
  // Row i: 2^8 / root of m, to the nearest; m = 1 + (i + 1/2) / 2^7, twice that behind an odd power
  // of two: the largest n with (2 n - 1)^2 m <= 2^18. 2^7 to 2^8.
  function [7:0] row_of(input integer i);
    integer twice, nearest, n;
    begin
      twice = (257 + 2 * (i % 128)) * (i < 128 ? 1 : 2);  // 2^8 m
      nearest = 0;
      for (n = 128; n <= 256; n = n + 1) begin
        if ((2 * n - 1) * (2 * n - 1) <= 67108864 / twice) nearest = n;
      end
      row_of = {nearest == 256, nearest[6:0]};
    end
  endfunction
  reg [7:0] rows[0:255];
  integer i;
  initial for (i = 0; i < 256; i = i + 1) rows[i] = row_of(i);
  wire is_odd = ~x[7];  // the bias is odd
  wire [7:0] row = rows[{is_odd, x[6:0]}];
  wire [7:0] half_power = {1'b0, x[14:8]} + {7'b0, x[7]};  // of the even power, + 64
  assign seed = {1'b0, 8'd189 - half_power + {7'b0, row[7]}, row[6:0], 16'b0};
endmodule
