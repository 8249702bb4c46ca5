// Whether a number lies between two others, or is one of them.
module between (
    input [31:0] low,
    input [31:0] high,
    input [31:0] x,
    output is
);
  wire from_low, to_high;
  less_or_equal of_low (
      .a(low),
      .b(x),
      .is(from_low)
  );
  less_or_equal of_high (
      .a(x),
      .b(high),
      .is(to_high)
  );
  assign is = from_low & to_high;
endmodule
