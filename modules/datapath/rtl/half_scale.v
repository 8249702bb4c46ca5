// The end of 2^t in half precision: x times a power of two, 1 at most, rounded to the nearest half,
// ties to even. x: a normal half, or no number with whole = 0.
module half_scale (
    input [15:0] x,
    input [7:0] whole,  // two's complement
    output [15:0] scaled
);
  wire [8:0] exponent = {4'b0, x[14:10]} + {whole[7], whole};
  wire is_normal = ~exponent[8] & (exponent != 0);
  wire [8:0] below = 9'd1 - exponent;
  wire [22:0] fixed = {1'b1, x[9:0], 12'b0} >> (below > 9'd12 ? 4'd12 : below[3:0]);
  wire far = below > 9'd12;
  wire [10:0] kept = fixed[22:12];
  wire up = fixed[11] & (kept[0] | (fixed[10:0] != 0)) & ~far;
  wire [10:0] rounded = far ? 11'b0 : kept + {10'b0, up};
  assign scaled = is_normal ? {x[15], exponent[4:0], x[9:0]} :
      {x[15] & (rounded != 0), 4'b0, rounded};
endmodule
