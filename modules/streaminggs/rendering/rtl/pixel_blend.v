// A splat blended into one pixel (algorithm/splat/blend.h) on three lanes in turns of three cycles. In
// comments, t is the cycle from the beginning of the sub-tile; t modulo 3 is the phase.
//
//   lane  phase 0                       phase 1                              phase 2
//   0     t = 27: 2^rest, first step    t = 34: alpha                        t = 17: two squares
//   1     t = 30: 2^rest, second step   t = 37: weight, light that is left   t = 20: the exponent
//   2     t = 39: red                   t = 40: green                        t = 41: blue
module pixel_blend #(
    parameter IS_AHEAD = 0  // 1: one of the squares is made with their sum, at t = 14
) (
    input clock,
    input [1:0] phase,
    input [95:0] squares,        // phase 2: a, b, c of their sum, a the lowest
    output [31:0] square,        // t = 16: the one that is made here
    input [31:0] column_term,    // t = 20: B dx
    input [31:0] row_distance,   // dy
    input [31:0] opacity,        // t = 34
    input is_inside,             // t = 37: of the frame
    input [127:0] state,         // from t = 37 on: finished; light; red, green, blue
    input [31:0] red,            // from t = 39 on
    input [31:0] green,
    input [31:0] blue,
    output writes_light,         // t = 44
    output writes_colour,
    output [127:0] result,
    output is_finished
);
  localparam [31:0] NOTHING = 32'h80000000;
  localparam [31:0] LEAST_EXPONENT = 32'hC2FA0000;  // -125
  localparam [31:0] MOST_ALPHA = 32'h3F7D70A4;      // 0.99
  localparam [31:0] LEAST_ALPHA = 32'h3B808081;     // 1/255
  localparam [31:0] LEAST_LIGHT = 32'h38D1B717;     // 1e-4

  wire in_phase_0 = phase == 2'd0, in_phase_1 = phase == 2'd1, in_phase_2 = phase == 2'd2;
  wire [31:0] product_0, product_1, product_2, sum_0, sum_1, sum_2;
  wire unused = &{1'b0, product_2};

  // t = 20: the squares' sum.
  assign square = product_0;
  wire [31:0] sum_of_squares;
  generate
    if (IS_AHEAD != 0) begin : ahead
      reg [31:0] held;
      always @(posedge clock) if (in_phase_2) held <= sum_0;
      assign sum_of_squares = held;
    end else begin : in_time
      assign sum_of_squares = sum_0;
    end
  endgenerate

  // t = 23: the exponent, no less than LEAST_EXPONENT.
  reg [31:0] exponent;
  reg [3:0] is_rising;
  wire above_least;
  less_or_equal of_least (
      .a(sum_1),
      .b(LEAST_EXPONENT),
      .is(above_least)
  );
  always @(posedge clock) begin
    if (in_phase_2) begin
      exponent <= above_least ? LEAST_EXPONENT : sum_1;
      is_rising <= {is_rising[2:0], ~sum_1[31] & sum_1[30:0] != 0};
    end
  end

  // t = 24: steps and rest; t = 25: the row of these steps.
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
  wire [31:0] constant, linear, square_factor;
  exp2_table table_of_64 (
      .row(row_1),
      .constant(constant),
      .linear(linear),
      .square(square_factor)
  );
  reg [31:0] constant_1, constant_2, linear_1, square_1;
  always @(posedge clock) begin
    if (in_phase_0) begin
      {rest_2, rest_1} <= {rest_1, rest};
      {whole_3, whole_2, whole_1} <= {whole_2, whole_1, whole};
      row_1 <= row;
    end
    if (in_phase_1) begin
      {constant_2, constant_1} <= {constant_1, constant};
      {linear_1, square_1} <= {linear, square_factor};
    end
  end

  // t = 33: 2^exponent; 0 where it would be above 1. t = 36: alpha, a product.
  reg [31:0] falloff, alpha;
  wire is_most, is_least;
  less_or_equal of_most_alpha (
      .a(MOST_ALPHA),
      .b(product_0),
      .is(is_most)
  );
  wire [31:0] limited = is_most ? MOST_ALPHA : product_0;
  less_or_equal of_least_alpha (
      .a(LEAST_ALPHA),
      .b(limited),
      .is(is_least)
  );
  always @(posedge clock) begin
    if (in_phase_0) begin
      falloff <= is_rising[3] ? 32'b0 : {sum_1[31:23] + {whole_3[7], whole_3}, sum_1[22:0]};
      alpha <= is_least ? limited : 32'b0;
    end
  end

  // t = 37: the pixel as it is. One pass of a lane gives the weight, negated, at t = 39 and the light
  // that is left at t = 40. The pixel ends where that is too little.
  wire hits = alpha != 0 & ~state[127] & is_inside;
  wire [31:0] light = {1'b0, state[126:96]}, weight = {~product_1[31], product_1[30:0]};
  reg hits_1, was_finished_1, ends_1, blends_1, is_finished_1, ends_2, blends_2, is_finished_2;
  reg [31:0] weight_1, light_left_1, light_left_2, red_1, green_1;
  reg [94:0] state_1;  // light, green, blue
  wire enough;
  less_or_equal of_least_light (
      .a(LEAST_LIGHT),
      .b(sum_1),
      .is(enough)
  );
  always @(posedge clock) begin
    if (in_phase_0) begin
      state_1 <= {state[126:96], state[63:0]};
      weight_1 <= weight;
      red_1 <= sum_2;
    end
    if (in_phase_1) begin
      hits_1 <= hits;
      was_finished_1 <= state[127] | ~is_inside;
      light_left_1 <= enough ? sum_1 : {1'b1, state_1[94:64]};
      ends_1 <= hits_1 & ~enough;
      blends_1 <= hits_1 & enough;
      is_finished_1 <= was_finished_1 | (hits_1 & ~enough);
      {light_left_2, ends_2, blends_2, is_finished_2} <=
          {light_left_1, ends_1, blends_1, is_finished_1};
      green_1 <= sum_2;
    end
  end
  assign writes_light = ends_2 | blends_2;
  assign writes_colour = blends_2;
  assign result = {light_left_2, red_1, green_1, sum_2};
  assign is_finished = is_finished_2;

  wire [95:0] of_0 = in_phase_0 ? {linear_1, rest_1, square_1} : in_phase_1 ? {NOTHING, falloff, opacity} :
      squares;
  wire [95:0] of_1 = in_phase_0 ? {constant_2, rest_2, sum_0} :
      in_phase_1 ? {light, light, 1'b1, alpha[30:0]} : {sum_of_squares, row_distance, column_term};
  wire [95:0] of_2 = in_phase_0 ? {state[95:64], weight, red} :
      in_phase_1 ? {state_1[63:32], weight_1, green} : {state_1[31:0], weight_1, blue};
  chaining_lane lane_0 (
      .clock(clock),
      .operands(of_0),
      .product(product_0),
      .sum(sum_0)
  );
  chaining_lane lane_1 (
      .clock(clock),
      .operands(of_1),
      .product(product_1),
      .sum(sum_1)
  );
  chaining_lane lane_2 (
      .clock(clock),
      .operands(of_2),
      .product(product_2),
      .sum(sum_2)
  );
endmodule
