// A comparator of whole numbers: keys, addresses, slots.
module word_comparator (
    input [31:0] a,
    input [31:0] b,
    output less,
    output equal
);
  assign less = a < b;
  assign equal = a == b;
endmodule
