// Which nodes a delete reads before it is known which child's key fills the hole: those with keys, below
// children that would be left with a hole themselves.
module ahead_reads #(
    parameter COUNT_BITS = 9
) (
    input deletes,
    input [COUNT_BITS-1:0] below_left,
    input [COUNT_BITS-1:0] below_right,
    input [3:0] has_keys,  // below the right child, below the left one
    output [3:0] reads
);
  localparam [COUNT_BITS:0] TWO = 2;
  wire left = deletes & {1'b0, below_left} > TWO, right = deletes & {1'b0, below_right} > TWO;
  assign reads = has_keys & {right, right, left, left};
endmodule
