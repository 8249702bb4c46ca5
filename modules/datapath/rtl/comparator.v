// A comparator beside the lanes: one operation a cycle on words of 32 bits, or on halves. Numbers
// compare as in C++: none is less or equal where one is no number, and zeros are equal.
module comparator #(
    parameter EXPONENT_BITS = 8,
    parameter FRACTION_BITS = 23,
    parameter [5:0] HAS = 6'b111111,  // its operations, from bit 0
    parameter SIGN = EXPONENT_BITS + FRACTION_BITS
) (
    input [2:0] operation,
    input [SIGN:0] a,
    input [SIGN:0] b,
    output less,           // of the numbers
    output less_or_equal,
    output reg [SIGN:0] value
);
  localparam COUNT_BITS = SIGN > 16 ? 5 : 4;
  localparam [2:0] MINIMUM = 0;  // of numbers: b if b < a, else a
  localparam [2:0] MAXIMUM = 1;  // b if a < b, else a
  localparam [2:0] ADD = 2;      // of whole numbers; also to an exponent
  localparam [2:0] LEFT = 3;     // a moved by b places
  localparam [2:0] RIGHT = 4;
  localparam [2:0] ZEROS = 5;    // in front of the first one of a

  wire a_nan = (&a[SIGN-1:FRACTION_BITS]) & (a[FRACTION_BITS-1:0] != 0);
  wire b_nan = (&b[SIGN-1:FRACTION_BITS]) & (b[FRACTION_BITS-1:0] != 0);
  wire both_zero = (a[SIGN-1:0] | b[SIGN-1:0]) == 0;
  wire equal = (a == b) | both_zero;
  wire magnitude_less = a[SIGN-1:0] < b[SIGN-1:0];
  wire below = a[SIGN] != b[SIGN] ? a[SIGN] & ~both_zero :
      a[SIGN] ? ~magnitude_less & (a[SIGN-1:0] != b[SIGN-1:0]) : magnitude_less;
  wire ordered = ~(a_nan | b_nan);
  assign less = HAS[0] & ordered & below;
  assign less_or_equal = HAS[0] & ordered & (below | equal);
  wire greater = ordered & ~below & ~equal;

  wire [COUNT_BITS-1:0] zeros;
  leading_zeros #(
      .WIDTH(SIGN + 1),
      .COUNT_BITS(COUNT_BITS)
  ) leading (
      .x(a),
      .count(zeros)
  );
  wire takes_b = (operation == MINIMUM & HAS[0] & greater) | (operation == MAXIMUM & HAS[1] & less);
  always @* begin
    case (operation)
      ADD: value = HAS[2] ? a + b : a;
      LEFT: value = HAS[3] ? a << b[COUNT_BITS-1:0] : a;
      RIGHT: value = HAS[4] ? a >> b[COUNT_BITS-1:0] : a;
      ZEROS: value = HAS[5] ? {{SIGN + 1 - COUNT_BITS{1'b0}}, zeros} : a;
      default: value = takes_b ? b : a;
    endcase
  end
endmodule
