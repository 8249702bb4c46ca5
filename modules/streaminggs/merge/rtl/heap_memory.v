// The nodes of a level in four banks, by the last bits of a node's place, each with a read and a write
// port. What is read is there a cycle later and stays until another read of that bank. A node that is read
// as it is written is the one before.
module heap_memory #(
    parameter NODES = 128,
    parameter WIDTH = 520,
    parameter ADDRESS_BITS = 5  // of a bank
) (
    input clock,
    input [3:0] reads,
    input [ADDRESS_BITS-1:0] read_at,
    output [4*WIDTH-1:0] read,
    input [3:0] writes,
    input [ADDRESS_BITS-1:0] write_at,
    input [WIDTH-1:0] written
);
  genvar b;
  generate
    for (b = 0; b < 4; b = b + 1) begin : banks
      if (b < NODES) begin : filled
        reg [WIDTH-1:0] nodes[0:(NODES+3-b)/4-1];
        reg [WIDTH-1:0] found;
        always @(posedge clock) begin
          if (reads[b]) found <= nodes[read_at];
          if (writes[b]) nodes[write_at] <= written;
        end
        assign read[b*WIDTH+:WIDTH] = found;
      end else begin : empty
        wire unused = &{1'b0, reads[b], writes[b]};
        assign read[b*WIDTH+:WIDTH] = 0;
      end
    end
  endgenerate
endmodule
