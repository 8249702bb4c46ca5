// A whole number of 20 bits as a number of single precision.
module whole_number (
    input [19:0] whole,
    output [31:0] number
);
  wire [4:0] zeros;
  leading_zeros #(
      .WIDTH(20),
      .COUNT_BITS(5)
  ) leading (
      .x(whole),
      .count(zeros)
  );
  wire [18:0] fraction = whole[18:0] << zeros;
  assign number = whole == 0 ? 32'b0 : {1'b0, 8'd146 - {3'b0, zeros}, fraction, 4'b0};
endmodule
