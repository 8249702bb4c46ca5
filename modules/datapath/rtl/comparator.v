// A comparator beside the lanes: one operation a cycle on words of 32 bits. Numbers compare as in
// C++: none is less or equal where one is no number, and zeros are equal.
module comparator #(
    parameter [5:0] HAS = 6'b111111  // its operations, from bit 0
) (
    input [2:0] operation,
    input [31:0] a,
    input [31:0] b,
    output less,           // of the numbers
    output less_or_equal,
    output reg [31:0] value
);
  localparam [2:0] MINIMUM = 0;  // of numbers: b if b < a, else a
  localparam [2:0] MAXIMUM = 1;  // b if a < b, else a
  localparam [2:0] ADD = 2;      // of whole numbers; also to an exponent
  localparam [2:0] LEFT = 3;     // a moved by b places
  localparam [2:0] RIGHT = 4;
  localparam [2:0] ZEROS = 5;    // in front of the first one of a

  wire a_nan = (&a[30:23]) & (a[22:0] != 0), b_nan = (&b[30:23]) & (b[22:0] != 0);
  wire both_zero = (a[30:0] | b[30:0]) == 0;
  wire equal = (a == b) | both_zero;
  wire magnitude_less = a[30:0] < b[30:0];
  wire below = a[31] != b[31] ? a[31] & ~both_zero :
      a[31] ? ~magnitude_less & (a[30:0] != b[30:0]) : magnitude_less;
  wire ordered = ~(a_nan | b_nan);
  assign less = HAS[0] & ordered & below;
  assign less_or_equal = HAS[0] & ordered & (below | equal);
  wire greater = ordered & ~below & ~equal;

  wire [4:0] zeros;
  leading_zeros #(
      .WIDTH(32),
      .COUNT_BITS(5)
  ) leading (
      .x(a),
      .count(zeros)
  );
  always @* begin
    case (operation)
      MINIMUM: value = HAS[0] & greater ? b : a;
      MAXIMUM: value = HAS[1] & less ? b : a;
      ADD: value = HAS[2] ? a + b : a;
      LEFT: value = HAS[3] ? a << b[4:0] : a;
      RIGHT: value = HAS[4] ? a >> b[4:0] : a;
      ZEROS: value = HAS[5] ? {27'b0, zeros} : a;
      default: value = a;
    endcase
  end
endmodule
