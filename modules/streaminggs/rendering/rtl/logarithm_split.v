// What the logarithm of a number of 1 or more starts from: z 2^power is the number, z from 0.7 to 1.4;
// an inverse of z to 8 bits, and that inverse's logarithm, negated.
module logarithm_split (
    input [31:0] x,
    output [31:0] z,
    output [31:0] power,  // below 16
    output [31:0] inverse,
    output [31:0] logarithm
);
  localparam [31:0] LEAST = 32'h3F330000;  // z
  wire [31:0] above = x - LEAST;
  assign z = {x[31:23] - above[31:23], x[22:0]};

  // To a number.
  wire [3:0] whole = above[26:23];
  wire [31:0] of_2 = whole[1] ? {9'h080, whole[0], 22'b0} : {2'b0, {7{whole[0]}}, 23'b0};
  wire [31:0] of_4 = {9'h081, whole[1:0], 21'b0};
  assign power = whole[3] ? {9'h082, whole[2:0], 20'b0} : whole[2] ? of_4 : of_2;

  reg [63:0] row;
  assign {inverse, logarithm} = row;
  always @* begin
    case (above[22:19])
      4'd0: row = 64'h3FB30000_BEABB3B9;
      4'd1: row = 64'h3FAC0000_BE974716;
      4'd2: row = 64'h3FA50000_BE82012D;
      4'd3: row = 64'h3F9E0000_BE579E4A;
      4'd4: row = 64'h3F980000_BE2FF984;
      4'd5: row = 64'h3F930000_BE0DB957;
      4'd6: row = 64'h3F8E0000_BDD4936A;
      4'd7: row = 64'h3F890000_BD8B29B7;
      4'd8: row = 64'h3F850000_BD1CF43E;
      4'd9: row = 64'h3F800000_80000000;
      4'd10: row = 64'h3F720000_3D665B9E;
      4'd11: row = 64'h3F660000_3DDB5644;
      4'd12: row = 64'h3F5A0000_3E2489EC;
      4'd13: row = 64'h3F4E0000_3E5E843A;
      4'd14: row = 64'h3F440000_3E88BC74;
      default: row = 64'h3F3C0000_3E9E1294;    endcase
  end
  wire unused = &{1'b0, above[18:0]};
endmodule
