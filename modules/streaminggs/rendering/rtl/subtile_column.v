// The column of sub-tiles, in the frame, of the last pixel centre at or before x; -1 left of the frame.
module subtile_column (
    input [31:0] x,
    output [17:0] column
);
  localparam [7:0] FIRST = 8'd129, RIGHT_OF_ALL = 8'd144;  // exponents of 4, 131072

  wire [7:0] field = x[30:23];
  wire is_left = (x[31] & x[30:0] != 0) | (&field & x[22:0] != 0);
  wire [14:0] whole = {1'b1, x[22:9]} >> (RIGHT_OF_ALL - 8'd1 - field);
  assign column = is_left ? 18'h3FFFF : field >= RIGHT_OF_ALL ? 18'd32768 :
      field < FIRST ? 18'd0 : {3'b0, whole};
  wire unused = &{1'b0, x[8:0]};
endmodule
