// All modules that stand beside lanes, so that they are compiled once.
module beside_lanes (
    input [2:0] operation,
    input [31:0] a,
    input [31:0] b,
    output less,
    output less_or_equal,
    output [31:0] value,
    output less_word,
    output equal_word,
    input [1:0] to,
    output [31:0] whole,
    output [31:0] reciprocal,
    output set_last_bit,
    output [31:0] half_inverse_root,
    output [31:0] inverse_root_above,
    output [31:0] rest,
    output [7:0] exponent,
    output [31:0] constant,
    output [31:0] linear,
    output [31:0] square,
    input [15:0] half,
    input [15:0] other_half,
    output less_half,
    output less_or_equal_half,
    output [15:0] value_half,
    output [15:0] rest_half,
    output [7:0] exponent_half,
    output [15:0] constant_half,
    output [15:0] linear_half,
    input [7:0] power,
    output [15:0] scaled_half,
    input clock,
    input [1:0] select,
    input [127:0] choices,
    output [31:0] chosen
);
  comparator compare (
      .operation(operation),
      .a(a),
      .b(b),
      .less(less),
      .less_or_equal(less_or_equal),
      .value(value)
  );
  word_comparator words (
      .a(a),
      .b(b),
      .less(less_word),
      .equal(equal_word)
  );
  comparator #(
      .EXPONENT_BITS(5),
      .FRACTION_BITS(10),
      .HAS(6'b000011)
  ) compare_halves (
      .operation(operation),
      .a(half),
      .b(other_half),
      .less(less_half),
      .less_or_equal(less_or_equal_half),
      .value(value_half)
  );
  rounding round (
      .to(to),
      .x(a),
      .whole(whole)
  );
  reciprocal_seed divisor (
      .d(a),
      .seed(reciprocal),
      .set_last_bit(set_last_bit)
  );
  root_seed root (
      .x(a[30:16]),
      .seed(half_inverse_root)
  );
  reach_table reach (
      .x(a[30:16]),
      .above(inverse_root_above)
  );
  wire [5:0] row, row_half;
  exp2_split #(
      .EXPONENT_BITS(8),
      .FRACTION_BITS(23)
  ) split (
      .t(a),
      .rest(rest),
      .row(row),
      .whole(exponent)
  );
  exp2_table table_of_64 (
      .row(row),
      .constant(constant),
      .linear(linear),
      .square(square)
  );
  exp2_split #(
      .EXPONENT_BITS(5),
      .FRACTION_BITS(10)
  ) split_half (
      .t(half),
      .rest(rest_half),
      .row(row_half),
      .whole(exponent_half)
  );
  exp2_table_half table_half (
      .row(row_half),
      .constant(constant_half),
      .linear(linear_half)
  );
  half_scale scale (
      .x(half),
      .whole(power),
      .scaled(scaled_half)
  );
  choice #(
      .WORDS(4),
      .SELECT_BITS(2)
  ) choose (
      .clock(clock),
      .select(select),
      .words(choices),
      .chosen(chosen)
  );
endmodule
