// A number made whole.
module rounding (
    input [1:0] to,
    input [31:0] x,
    output [31:0] whole
);
  localparam [1:0] ZERO = 0, BELOW = 1, ABOVE = 2;  // else to the nearest, halves away from zero

  wire sign = x[31];
  wire [7:0] field = x[30:23];
  wire is_whole = field >= 8'd150;  // or no number
  wire is_small = field < 8'd127;   // magnitude below 1

  // Places behind the point, of which the first decides on the nearest.
  wire [4:0] places = 5'd21 - field[4:0];  // less one
  wire [23:0] behind = is_small ? 24'hFFFFFF : (24'd2 << places) - 24'd1;
  wire [23:0] digits = is_small ? {1'b0, x[30:0] != 0, 22'b0} : {1'b1, x[22:0]};
  wire any = (digits & behind) != 0;
  wire half = is_small ? field == 8'd126 : (digits & (24'd1 << places)) != 0;
  wire away = to == ZERO ? 1'b0 : to == BELOW ? sign & any : to == ABOVE ? ~sign & any : half;

  // One more in the last place before the point: a carry goes into the exponent.
  wire [30:0] cut = x[30:0] & ~{7'b0, behind};
  wire [30:0] raised = cut + {7'b0, behind & {24{away}}} + {30'b0, away};
  assign whole = is_whole ? x : is_small ? {sign, away ? 31'h3F800000 : 31'h0} : {sign, raised};
endmodule
