// One of several words, as each input of a lane has it. Which one is known a cycle before, and has a
// register bit for each word: so words that are not chosen move nothing behind their first gates.
module choice #(
    parameter WORDS = 2,
    parameter SELECT_BITS = 1
) (
    input clock,
    input [SELECT_BITS-1:0] select,
    input [WORDS*32-1:0] words,
    output [31:0] chosen
);
  reg [WORDS-1:0] selected;
  genvar w, b;
  generate
    for (w = 0; w < WORDS; w = w + 1) begin : word
      always @(posedge clock) selected[w] <= select == w;
    end
    for (b = 0; b < 32; b = b + 1) begin : of_bit
      wire [WORDS-1:0] passes;
      for (w = 0; w < WORDS; w = w + 1) begin : from
        assign passes[w] = selected[w] & words[32*w+b];
      end
      assign chosen[b] = |passes;
    end
  endgenerate
endmodule
