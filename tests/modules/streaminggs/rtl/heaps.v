// Heaps under test, side by side: the merge unit's, and one of few keys, an odd number.
module heaps (
    input clock,
    input reset,
    input clears,
    input begins,
    input inserts,
    input at_high,
    input [255:0] key,
    output [9:0] size,
    output [255:0] nearest,
    output [255:0] farthest,
    output [31:0] reads,
    output [31:0] writes,
    input few_clears,
    input few_begins,
    input few_inserts,
    input few_at_high,
    input [95:0] few_key,
    output [3:0] few_size,
    output [95:0] few_nearest,
    output [95:0] few_farthest,
    output [7:0] few_reads,
    output [7:0] few_writes
);
  interval_heap #(
      .ENTRIES(512),
      .KEY_BITS(256),
      .COMPARED_BITS(64)
  ) merge (
      .clock(clock),
      .reset(reset),
      .clears(clears),
      .begins(begins),
      .inserts(inserts),
      .at_high(at_high),
      .key(key),
      .size(size),
      .nearest(nearest),
      .farthest(farthest),
      .reads(reads),
      .writes(writes)
  );
  interval_heap #(
      .ENTRIES(11),
      .KEY_BITS(96),
      .COMPARED_BITS(64)
  ) few (
      .clock(clock),
      .reset(reset),
      .clears(few_clears),
      .begins(few_begins),
      .inserts(few_inserts),
      .at_high(few_at_high),
      .key(few_key),
      .size(few_size),
      .nearest(few_nearest),
      .farthest(few_farthest),
      .reads(few_reads),
      .writes(few_writes)
  );
endmodule
