// A compare-exchange: two keys and their places leave in order, a cycle later.
module compare_exchange #(
    parameter KEY_BITS = 64,
    parameter PLACE_BITS = 8
) (
    input clock,
    input [KEY_BITS-1:0] a,
    input [KEY_BITS-1:0] b,
    input [PLACE_BITS-1:0] a_place,
    input [PLACE_BITS-1:0] b_place,
    output reg [KEY_BITS-1:0] nearer,
    output reg [KEY_BITS-1:0] farther,
    output reg [PLACE_BITS-1:0] nearer_place,
    output reg [PLACE_BITS-1:0] farther_place
);
  wire exchanges = b < a;
  always @(posedge clock) begin
    nearer <= exchanges ? b : a;
    farther <= exchanges ? a : b;
    nearer_place <= exchanges ? b_place : a_place;
    farther_place <= exchanges ? a_place : b_place;
  end
endmodule
