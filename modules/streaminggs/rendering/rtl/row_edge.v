// The farther one of a row's edges to one side: of its own and of the one above it, which is that
// of the row previous or, of a first row, the begun one. An edge beside the ellipse is nowhere.
module row_edge (
    input clock,
    input now,                // a row is here
    input [31:0] bound,
    input [31:0] under_root,  // less than 0: beside the ellipse
    input [31:0] begun,       // all ones but for the sign: there is a row previous
    output [31:0] most
);
  localparam [31:0] NOWHERE = 32'hF149F2CA;  // -1e30

  wire touches, below_is_less;
  less_or_equal of_ellipse (
      .a(32'b0),
      .b(under_root),
      .is(touches)
  );
  wire [31:0] below = touches ? bound : NOWHERE;
  reg [31:0] previous;
  always @(posedge clock) if (now) previous <= below;
  wire [31:0] above = &begun[30:0] ? previous : begun;
  less_or_equal farther (
      .a(below),
      .b(above),
      .is(below_is_less)
  );
  assign most = below_is_less ? above : below;
endmodule
