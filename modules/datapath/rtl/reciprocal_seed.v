// What the reciprocal of a normal number starts from: its nearest value of 8 bits in the middle of
// the row that the first 8 digits of its fraction pick. The steps that follow (lane_steps.h) err
// for one fraction, of ones alone: their result lacks its last bit.
module reciprocal_seed (
    input [31:0] d,
    output [31:0] seed,
    output set_last_bit
);
  // Row i: 2^8 / (1 + (i + 1/2) / 2^8), to the nearest; 2^7 to 2^8.
  function [7:0] row_of(input integer i);
    integer nearest;
    begin
      nearest = (2 * 131072 + 513 + 2 * i) / (2 * (513 + 2 * i));
      row_of = {nearest == 256, nearest[6:0]};
    end
  endfunction
  reg [7:0] rows[0:255];
  integer i;
  initial for (i = 0; i < 256; i = i + 1) rows[i] = row_of(i);
  wire [7:0] row = rows[d[22:15]];
  assign seed = {d[31], 8'd253 - d[30:23] + {7'b0, row[7]}, row[6:0], 16'b0};
  assign set_last_bit = &d[22:0];
endmodule
