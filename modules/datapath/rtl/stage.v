// Registers between two stages; wires where REGISTERED is 0.
module stage #(
    parameter WIDTH = 1,
    parameter REGISTERED = 1
) (
    input clock,
    input [WIDTH-1:0] d,
    output [WIDTH-1:0] q
);
  generate
    if (REGISTERED != 0) begin : registers
      reg [WIDTH-1:0] held;
      always @(posedge clock) held <= d;
      assign q = held;
    end else begin : wires
      wire unused = clock;
      assign q = d;
    end
  endgenerate
endmodule
