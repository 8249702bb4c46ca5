// One of several words, as each input of a lane has it; which one is known a cycle before.
module choice #(
    parameter WORDS = 2,
    parameter SELECT_BITS = 1
) (
    input clock,
    input [SELECT_BITS-1:0] select,
    input [WORDS*32-1:0] words,
    output [31:0] chosen
);
  reg [SELECT_BITS-1:0] selected;
  always @(posedge clock) selected <= select;
  assign chosen = words[32*selected+:32];
endmodule
