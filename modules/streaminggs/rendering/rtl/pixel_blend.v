// A splat blended into one pixel (algorithm/splat/blend.h) on four lanes in turns of three cycles: ten
// steps of its own, and two for terms that the pixels of a sub-tile share. In comments, t is the cycle
// from the beginning of the sub-tile; t modulo 3 is the phase.
//
//   lane  phase 0         phase 1                         phase 2
//   0     a shared term   t = 13: two squares             t = 29: alpha
//   1     a shared term   t = 16: the exponent            t = 35: weight
//   2     t = 39: green   t = 22: 2^rest, first step      t = 38: light that is left
//   3     t = 39: blue    t = 25: 2^rest, second step     t = 38: red
module pixel_blend (
    input clock,
    input [1:0] phase,
    input [95:0] shared_0,      // a, b, c, a the lowest
    input [95:0] shared_1,
    output [31:0] sum_0,
    output [31:0] sum_1,
    input [31:0] column_square,  // t = 13: A dx dx
    input [31:0] row_square,     // C dy dy
    input [31:0] column_term,    // t = 16: B dx
    input [31:0] row_distance,   // dy
    input [31:0] opacity,        // t = 29
    input is_inside,             // t = 35: of the frame
    input [127:0] state,         // from t = 35 on: finished; light; red, green, blue
    input [31:0] red,            // t = 38
    input [31:0] green,          // t = 39
    input [31:0] blue,
    output writes_light,         // t = 42
    output writes_colour,
    output [127:0] result,
    output is_finished
);
  localparam [31:0] ONE = 32'h3F800000, NOTHING = 32'h80000000;
  localparam [31:0] LEAST_EXPONENT = 32'hC2FA0000;  // -125
  localparam [31:0] MOST_ALPHA = 32'h3F7D70A4;      // 0.99
  localparam [31:0] LEAST_ALPHA = 32'h3B808081;     // 1/255
  localparam [31:0] LEAST_LIGHT = 32'h38D1B717;     // 1e-4

  wire in_phase_0 = phase == 2'd0, in_phase_1 = phase == 2'd1, in_phase_2 = phase == 2'd2;
  wire [31:0] sum_2, sum_3;

  // t = 19: the exponent, no less than LEAST_EXPONENT.
  reg [31:0] exponent;
  reg [2:0] is_rising;
  wire above_least;
  less_or_equal of_least (
      .a(sum_1),
      .b(LEAST_EXPONENT),
      .is(above_least)
  );
  always @(posedge clock) begin
    if (in_phase_1) begin
      exponent <= above_least ? LEAST_EXPONENT : sum_1;
      is_rising <= {is_rising[1:0], ~sum_1[31] & sum_1[30:0] != 0};
    end
  end

  // t = 20: steps and rest; t = 21: the row of these steps.
  wire [31:0] rest;
  wire [5:0] row;
  wire [7:0] whole;
  exp2_split #(
      .EXPONENT_BITS(8),
      .FRACTION_BITS(23)
  ) split (
      .t(exponent),
      .rest(rest),
      .row(row),
      .whole(whole)
  );
  reg [31:0] rest_1, rest_2;
  reg [5:0] row_1;
  reg [7:0] whole_1, whole_2, whole_3;
  wire [31:0] constant, linear, square;
  exp2_table table_of_64 (
      .row(row_1),
      .constant(constant),
      .linear(linear),
      .square(square)
  );
  reg [31:0] constant_1, constant_2, linear_1, square_1;
  always @(posedge clock) begin
    if (in_phase_2) begin
      {rest_2, rest_1} <= {rest_1, rest};
      {whole_3, whole_2, whole_1} <= {whole_2, whole_1, whole};
      row_1 <= row;
    end
    if (in_phase_0) begin
      {constant_2, constant_1} <= {constant_1, constant};
      {linear_1, square_1} <= {linear, square};
    end
  end

  // t = 28: 2^exponent; 0 where it would be above 1. t = 32: alpha.
  reg [31:0] falloff, alpha;
  wire is_most, is_least;
  less_or_equal of_most_alpha (
      .a(MOST_ALPHA),
      .b(sum_0),
      .is(is_most)
  );
  wire [31:0] limited = is_most ? MOST_ALPHA : sum_0;
  less_or_equal of_least_alpha (
      .a(LEAST_ALPHA),
      .b(limited),
      .is(is_least)
  );
  always @(posedge clock) begin
    if (in_phase_1) falloff <= is_rising[2] ? 32'b0 : {sum_3[31:23] + {whole_3[7], whole_3}, sum_3[22:0]};
    if (in_phase_2) alpha <= is_least ? limited : 32'b0;
  end

  // t = 35: the pixel as it is, t = 41: as it is then. It ends where too little light would be left.
  wire hits = alpha != 0 & ~state[127] & is_inside;
  wire [31:0] light = {1'b0, state[126:96]};
  reg hits_1, hits_2, was_finished_1, was_finished_2;
  reg [126:0] state_1;
  reg [30:0] light_2;
  reg [31:0] weight, light_left, red_result;
  reg ends, blends, is_finished_1;
  wire enough;
  less_or_equal of_least_light (
      .a(LEAST_LIGHT),
      .b(sum_2),
      .is(enough)
  );
  always @(posedge clock) begin
    if (in_phase_1) begin
      state_1 <= state[126:0];
      light_2 <= state_1[126:96];
    end
    if (in_phase_2) begin
      {hits_2, hits_1} <= {hits_1, hits};
      {was_finished_2, was_finished_1} <= {was_finished_1, state[127] | ~is_inside};
      weight <= sum_1;
      light_left <= enough ? sum_2 : {1'b1, light_2};
      red_result <= sum_3;
      ends <= hits_2 & ~enough;
      blends <= hits_2 & enough;
      is_finished_1 <= was_finished_2 | (hits_2 & ~enough);
    end
  end
  assign writes_light = ends | blends;
  assign writes_colour = blends;
  assign result = {light_left, red_result, sum_2, sum_3};
  assign is_finished = is_finished_1;

  wire [95:0] of_0 = in_phase_0 ? shared_0 : in_phase_1 ? {row_square, ONE, column_square} :
      {NOTHING, falloff, opacity};
  wire [95:0] of_1 = in_phase_0 ? shared_1 : in_phase_1 ? {sum_0, row_distance, column_term} :
      {NOTHING, light, alpha};
  wire [95:0] of_2 = in_phase_0 ? {state_1[63:32], weight, green} :
      in_phase_1 ? {linear_1, rest_1, square_1} : {1'b0, state_1[126:96], ONE, ~sum_1[31], sum_1[30:0]};
  wire [95:0] of_3 = in_phase_0 ? {state_1[31:0], weight, blue} :
      in_phase_1 ? {constant_2, rest_2, sum_2} : {state_1[95:64], sum_1, red};
  chaining_lane lane_0 (
      .clock(clock),
      .operands(of_0),
      .sum(sum_0)
  );
  chaining_lane lane_1 (
      .clock(clock),
      .operands(of_1),
      .sum(sum_1)
  );
  chaining_lane lane_2 (
      .clock(clock),
      .operands(of_2),
      .sum(sum_2)
  );
  chaining_lane lane_3 (
      .clock(clock),
      .operands(of_3),
      .sum(sum_3)
  );
endmodule
