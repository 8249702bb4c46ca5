// The inverse root of a positive number, too large by 2^-9 to 2^-6.8 of itself: the function
// inverse_root_above() of algorithm/splat/extent_bound.h, for normal numbers. A row for the
// exponent's last bit and 7 digits of the fraction.
module reach_table (
    input [14:0] x,  // its exponent and the first 7 digits of its fraction
    output [31:0] above
);
  // 1 + 2^-9 over the root, each rounded to 24 digits. m: the first 8 digits, or twice that.
  function [23:0] row_of(input integer i);
    reg [63:0] m, root, quotient;
    integer place;
    begin
      m = {32'b0, (128 + i % 128) * (i < 128 ? 1 : 2)};
      m = m << 41;  // 4 (2^23)^2 times the square of the root
      root = 0;     // twice the root in units of 2^-23, rounded down
      for (place = 24; place >= 0; place = place - 1) begin
        if ((root + (64'd1 << place)) * (root + (64'd1 << place)) <= m) begin
          root = root + (64'd1 << place);
        end
      end
      root = (root + 1) >> 1;
      quotient = (64'd513 << 38) / root;  // in units of 2^-24; no row lies halfway
      if (quotient >= 64'd1 << 24) begin
        quotient = ((64'd513 << 38) / root + 1) >> 1;
        row_of = {1'b1, quotient[22:0]};
      end else begin
        quotient = (((64'd513 << 39) / root) + 1) >> 1;
        row_of = {1'b0, quotient[22:0]};
      end
    end
  endfunction
  reg [23:0] rows[0:255];
  integer i;
  initial for (i = 0; i < 256; i = i + 1) rows[i] = row_of(i);
  wire [23:0] row = rows[{~x[7], x[6:0]}];
  wire [7:0] half_power = {1'b0, x[14:8]} + {7'b0, x[7]};  // of the even power, + 64
  assign above = {1'b0, 8'd190 - half_power + {7'b0, row[23]}, row[22:0]};
endmodule
