// A splat blended into the 16 pixels of a sub-tile, on 64 lanes: a sub-tile every three cycles. In
// comments, t is the cycle from its beginning; it is given in the cycle before. Terms of a column or a
// row of pixels are made once, in lanes that their pixels leave free.
module subtile_blend (
    input clock,
    input [1:0] phase,        // t modulo 3
    input [287:0] splat,      // x, y, conic for powers of 2 (a, b, c), opacity, red, green, blue; x the lowest
    input [31:0] left,        // the sub-tile's first pixel, in the frame
    input [31:0] top,
    input [15:0] is_inside,   // t = 35
    input [2047:0] states,    // t = 35: pixel_blend.v; the first pixel the lowest
    output [15:0] writes_light,  // t = 42
    output [15:0] writes_colour,
    output [2047:0] results,
    output is_finished
);
  /* verilator hier_block */
  localparam [31:0] ONE = 32'h3F800000, NOTHING = 32'h80000000;

  // The splat's words as far as they wait: stage k is there from t = 3 k on.
  reg [127:0] places;  // x, y, left, top
  reg [95:0] conics[0:2];
  reg [31:0] opacities[0:9];
  reg [95:0] colours[0:13];
  integer i;
  always @(posedge clock) begin
    if (phase == 2'd2) begin
      places <= {top, left, splat[63:0]};
      conics[0] <= splat[159:64];
      opacities[0] <= splat[191:160];
      colours[0] <= splat[287:192];
      for (i = 1; i < 3; i = i + 1) conics[i] <= conics[i-1];
      for (i = 1; i < 10; i = i + 1) opacities[i] <= opacities[i-1];
      for (i = 1; i < 14; i = i + 1) colours[i] <= colours[i-1];
    end
  end
  wire [31:0] conic_a = conics[2][31:0], conic_b = conics[2][63:32], conic_c = conics[2][95:64];

  // Terms that pixels share, all in phase 0: the splat's distance from the first pixel, t = 0; from
  // each column and row, t = 3; A dx, B dx and C dy, t = 6; their products with dx and dy, t = 9.
  localparam ACROSS = 0, DOWN = 1, DX = 2, DY = 6, A_DX = 10, B_DX = 14, C_DY = 18, A_DX_DX = 22,
      C_DY_DY = 26, IDLE = 30;
  wire [32*96-1:0] operands;
  wire [32*32-1:0] sums;
  assign operands[ACROSS*96+:96] = {~places[95], places[94:64], ONE, places[31:0]};
  assign operands[DOWN*96+:96] = {~places[127], places[126:96], ONE, places[63:32]};
  assign operands[IDLE*96+:192] = 192'b0;
  wire unused = &{1'b0, sums[IDLE*32+:64]};
  reg [31:0] dx[0:3], a_dx_dx[0:3], b_dx_1[0:3], b_dx_2[0:3], b_dx_3[0:3], c_dy_dy[0:3];
  reg [31:0] dy_1[0:3], dy_2[0:3], dy_3[0:3], dy_4[0:3];
  wire [15:0] finished;
  genvar k;
  generate
    for (k = 0; k < 4; k = k + 1) begin : along
      localparam [31:0] MINUS = k == 0 ? 32'h80000000 : k == 1 ? 32'hBF800000 :
          k == 2 ? 32'hC0000000 : 32'hC0400000;
      wire [31:0] dx_now = sums[(DX+k)*32+:32], dy_now = sums[(DY+k)*32+:32];
      assign operands[(DX+k)*96+:96] = {MINUS, ONE, sums[ACROSS*32+:32]};
      assign operands[(DY+k)*96+:96] = {MINUS, ONE, sums[DOWN*32+:32]};
      assign operands[(A_DX+k)*96+:96] = {NOTHING, dx_now, conic_a};
      assign operands[(B_DX+k)*96+:96] = {NOTHING, dx_now, conic_b};
      assign operands[(C_DY+k)*96+:96] = {NOTHING, dy_now, conic_c};
      assign operands[(A_DX_DX+k)*96+:96] = {NOTHING, dx[k], sums[(A_DX+k)*32+:32]};
      assign operands[(C_DY_DY+k)*96+:96] = {NOTHING, dy_1[k], sums[(C_DY+k)*32+:32]};
      always @(posedge clock) begin
        if (phase == 2'd0) begin
          dx[k] <= dx_now;
          a_dx_dx[k] <= sums[(A_DX_DX+k)*32+:32];
          c_dy_dy[k] <= sums[(C_DY_DY+k)*32+:32];
          b_dx_1[k] <= sums[(B_DX+k)*32+:32];
          b_dx_2[k] <= b_dx_1[k];
          b_dx_3[k] <= b_dx_2[k];
          dy_1[k] <= dy_now;
          dy_2[k] <= dy_1[k];
          dy_3[k] <= dy_2[k];
          dy_4[k] <= dy_3[k];
        end
      end
    end

    for (k = 0; k < 16; k = k + 1) begin : pixels
      pixel_blend pixel (
          .clock(clock),
          .phase(phase),
          .shared_0(operands[2*k*96+:96]),
          .shared_1(operands[(2*k+1)*96+:96]),
          .sum_0(sums[2*k*32+:32]),
          .sum_1(sums[(2*k+1)*32+:32]),
          .column_square(a_dx_dx[k%4]),
          .row_square(c_dy_dy[k/4]),
          .column_term(b_dx_3[k%4]),
          .row_distance(dy_4[k/4]),
          .opacity(opacities[9]),
          .is_inside(is_inside[k]),
          .state(states[k*128+:128]),
          .red(colours[12][31:0]),
          .green(colours[13][63:32]),
          .blue(colours[13][95:64]),
          .writes_light(writes_light[k]),
          .writes_colour(writes_colour[k]),
          .result(results[k*128+:128]),
          .is_finished(finished[k])
      );
    end
  endgenerate
  assign is_finished = &finished;
endmodule
