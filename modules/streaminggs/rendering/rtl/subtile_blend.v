// A splat blended into the 16 pixels of a sub-tile, on 56 lanes: a sub-tile every three cycles. In
// comments, t is the cycle from its beginning; it is given in the cycle before. Terms of a column or a
// row of pixels are made once, on eight lanes, in turns of three cycles:
//
//   lane      phase 0                               phase 1          phase 2
//   0, 1      t = 0: distance of the first pixel    t = 4: dx        t = 8: A dx
//   2, 3      t = 12: A dx dx, C dy dy, first ones  t = 4: dx        t = 8: A dx
//   4 to 7    t = 9: B dx                           t = 4: dy        t = 8: C dy
//
// At t = 14 the other squares are made by pixels beside the first one, each with its sum.
module subtile_blend (
    input clock,
    input [1:0] phase,        // t modulo 3
    input [287:0] splat,      // x, y, conic for powers of 2 (a, b, c), opacity, red, green, blue; x the lowest
    input [31:0] left,        // the sub-tile's first pixel, in the frame
    input [31:0] top,
    input [15:0] is_inside,   // t = 37
    input [2047:0] states,    // t = 37: pixel_blend.v; the first pixel the lowest
    output [15:0] writes_light,  // t = 44
    output [15:0] writes_colour,
    output [2047:0] results,
    output is_finished
);
  /* verilator hier_block */
  localparam [31:0] ONE = 32'h3F800000, NOTHING = 32'h80000000;

  // The splat's words as far as they wait: stage k is there from t = 3 k on.
  reg [127:0] places;  // x, y, left, top
  reg [95:0] conics[0:2];
  reg [31:0] conic_b;
  reg [31:0] opacities[0:11];
  reg [95:0] colours[0:13];
  integer i;
  always @(posedge clock) begin
    if (phase == 2'd2) begin
      places <= {top, left, splat[63:0]};
      conics[0] <= splat[159:64];
      opacities[0] <= splat[191:160];
      colours[0] <= splat[287:192];
      for (i = 1; i < 3; i = i + 1) conics[i] <= conics[i-1];
      conic_b <= conics[2][63:32];
      for (i = 1; i < 12; i = i + 1) opacities[i] <= opacities[i-1];
      for (i = 1; i < 14; i = i + 1) colours[i] <= colours[i-1];
    end
  end
  wire [31:0] conic_a = conics[2][31:0], conic_c = conics[2][95:64];

  wire [32*8-1:0] products, sums;
  wire [96*8-1:0] in_phase_0, in_phase_1, in_phase_2;
  reg [31:0] across, down;  // t = 4
  reg [31:0] dx_1[0:3], dx_2[0:3], dx_3[0:3];  // t = 8, 11, 14
  reg [31:0] dy_1[0:3], dy_2[0:3], dy_3[0:3], dy_4[0:3], dy_5[0:3];
  reg [31:0] a_dx_1[0:3], a_dx_2[0:3], c_dy_1[0:3], c_dy_2[0:3];  // t = 11, 14
  reg [31:0] b_dx_1[0:3], b_dx_2[0:3], b_dx_3[0:3];  // t = 12, 15, 18
  reg [31:0] a_dx_dx[0:3], c_dy_dy[0:3];  // t = 17
  wire [31:0] a_dx_dx_0 = products[64+:32], c_dy_dy_0 = products[96+:32];  // t = 14
  assign in_phase_0[0+:96] = {~places[95], places[94:64], ONE, places[31:0]};
  assign in_phase_0[96+:96] = {~places[127], places[126:96], ONE, places[63:32]};
  assign in_phase_0[192+:96] = {NOTHING, dx_2[0], a_dx_1[0]};
  assign in_phase_0[288+:96] = {NOTHING, dy_2[0], c_dy_1[0]};
  always @(posedge clock) begin
    if (phase == 2'd0) begin
      across <= sums[0+:32];
      down <= sums[32+:32];
    end
    if (phase == 2'd2) begin
      a_dx_dx[0] <= a_dx_dx_0;
      c_dy_dy[0] <= c_dy_dy_0;
    end
  end

  wire [15:0] finished;
  wire [32*16-1:0] squares;  // of those that are made ahead
  wire unused = &{1'b0, squares};
  genvar k;
  generate
    for (k = 0; k < 4; k = k + 1) begin : along
      localparam [31:0] MINUS = k == 0 ? 32'h80000000 : k == 1 ? 32'hBF800000 :
          k == 2 ? 32'hC0000000 : 32'hC0400000;
      assign in_phase_0[(4+k)*96+:96] = {NOTHING, dx_1[k], conic_b};
      assign in_phase_1[k*96+:96] = {MINUS, ONE, across};
      assign in_phase_1[(4+k)*96+:96] = {MINUS, ONE, down};
      assign in_phase_2[k*96+:96] = {NOTHING, dx_1[k], conic_a};
      assign in_phase_2[(4+k)*96+:96] = {NOTHING, dy_1[k], conic_c};
      always @(posedge clock) begin
        if (phase == 2'd1) begin
          dx_1[k] <= sums[k*32+:32];
          dx_2[k] <= dx_1[k];
          dx_3[k] <= dx_2[k];
          dy_1[k] <= sums[(4+k)*32+:32];
          dy_2[k] <= dy_1[k];
          dy_3[k] <= dy_2[k];
          dy_4[k] <= dy_3[k];
          dy_5[k] <= dy_4[k];
          a_dx_1[k] <= products[k*32+:32];
          a_dx_2[k] <= a_dx_1[k];
          c_dy_1[k] <= products[(4+k)*32+:32];
          c_dy_2[k] <= c_dy_1[k];
        end
        if (phase == 2'd2) begin
          b_dx_1[k] <= products[(4+k)*32+:32];
          b_dx_2[k] <= b_dx_1[k];
          b_dx_3[k] <= b_dx_2[k];
        end
      end
      if (k > 0) begin : behind
        always @(posedge clock) begin
          if (phase == 2'd1) begin
            a_dx_dx[k] <= squares[k*32+:32];
            c_dy_dy[k] <= squares[4*k*32+:32];
          end
        end
      end
    end

    for (k = 0; k < 8; k = k + 1) begin : shared
      chaining_lane lane (
          .clock(clock),
          .operands(phase == 2'd0 ? in_phase_0[k*96+:96] : phase == 2'd1 ? in_phase_1[k*96+:96] :
              in_phase_2[k*96+:96]),
          .product(products[k*32+:32]),
          .sum(sums[k*32+:32])
      );
    end

    for (k = 0; k < 16; k = k + 1) begin : pixels
      localparam COLUMN = k % 4, ROW = k / 4;
      localparam IS_AHEAD = (COLUMN == 0) != (ROW == 0);
      wire [95:0] of_squares;
      if (!IS_AHEAD) begin : of_both
        assign of_squares = {c_dy_dy[ROW], ONE, a_dx_dx[COLUMN]};
      end else if (ROW == 0) begin : of_column
        assign of_squares = {c_dy_dy_0, dx_3[COLUMN], a_dx_2[COLUMN]};
      end else begin : of_row
        assign of_squares = {a_dx_dx_0, dy_3[ROW], c_dy_2[ROW]};
      end
      pixel_blend #(
          .IS_AHEAD(IS_AHEAD)
      ) pixel (
          .clock(clock),
          .phase(phase),
          .squares(of_squares),
          .square(squares[k*32+:32]),
          .column_term(b_dx_3[COLUMN]),
          .row_distance(dy_5[ROW]),
          .opacity(opacities[11]),
          .is_inside(is_inside[k]),
          .state(states[k*128+:128]),
          .red(colours[13][31:0]),
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
