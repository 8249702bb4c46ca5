// Pixels of one place in the sub-tiles of a cluster: light and the flag of a finished pixel in front of
// it, then red, green, blue. What is read is there a cycle later.
module pixel_memory #(
    parameter ENTRIES = 144,
    parameter ADDRESS_BITS = 8
) (
    input clock,
    input reads,
    input [ADDRESS_BITS-1:0] read_at,
    output reg [127:0] read,
    input writes_light,
    input writes_colour,
    input [ADDRESS_BITS-1:0] write_at,
    input [127:0] written
);
  reg [127:0] pixels[0:ENTRIES-1];
  always @(posedge clock) begin
    if (reads) read <= pixels[read_at];
    if (writes_light) pixels[write_at][127:96] <= written[127:96];
    if (writes_colour) pixels[write_at][95:0] <= written[95:0];
  end
endmodule
