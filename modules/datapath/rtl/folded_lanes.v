// A computation on fewer lanes than it has steps: each lane begins a step a cycle, and the next item
// comes `INTERVAL` cycles later. The order of PROGRAM is the order in which steps get their cycles: the
// first in which their operands are there and a lane is free.
//
// A step of PROGRAM has 32 bits, the first step the highest ones:
//   31: outside: its value is made of a, b, c by who instantiates this, in its cycle
//   30: the lane's product, which is there a cycle before the sum
//   31, 30: the product of step a, whose sum is that step: no lane of its own
//   29: of a product that is not rounded
//   28, 27: a, c negated
//   23:16, 15:8, 7:0: a, b, c: number of a step, 128 + number of an input, 192 + number of a constant
// Values wait in registers, until the last step has taken them, or the item ends if they are KEPT.
module folded_lanes #(
    parameter STEPS = 1,
    parameter INPUTS = 1,
    parameter CONSTANTS = 1,
    parameter LANES = 1,
    parameter INTERVAL = 1,
    parameter [STEPS*32-1:0] PROGRAM = 0,
    parameter [CONSTANTS*32-1:0] NUMBERS = 0,  // the first the lowest
    parameter [STEPS-1:0] KEPT = 0,            // the first the lowest
    parameter LANE_CYCLES = 3,
    parameter VALUES = STEPS + INPUTS + 1
) (
    input clock,
    input [7:0] phase,                // cycles of an item, modulo INTERVAL
    input begins,                     // an item comes, in the last phase
    input [INPUTS*32-1:0] inputs,
    output [STEPS*128-1:0] operands,  // of steps: a, b, c, a the lowest; whether it is their cycle
    input [STEPS*32-1:0] outside,
    output [STEPS*32-1:0] kept,
    output ends                       // what is kept is there
);
  localparam INPUT = 128, CONSTANT = 192;
  localparam PHASE_BITS = INTERVAL > 4 ? 3 : INTERVAL > 2 ? 2 : 1;

  function [31:0] step_of(input integer step);
    step_of = PROGRAM[(STEPS-1-step)*32+:32];
  endfunction

  function [1:0] kind_of(input integer step);
    kind_of = PROGRAM[(STEPS-1-step)*32+30+:2];
  endfunction

  // The cycle in which a step begins and its lane, 32 bits each.
  function [STEPS*64-1:0] scheduled(input integer unused);
    reg [INTERVAL*32-1:0] taken;
    reg [31:0] step;
    integer i, port, cycle, there, turns, source;
    begin
      taken = 0;
      scheduled = 0;
      for (i = 0; i < STEPS; i = i + 1) begin
        step = step_of(i);
        cycle = 0;
        for (port = 0; port < 3; port = port + 1) begin
          source = {24'b0, step[8*port+:8]};
          if (source < INPUT) begin
            there = scheduled[64*source+:32] + latency_of(kind_of(source));
            if (there > cycle) cycle = there;
          end
        end
        if (step[31] & step[30]) begin
          scheduled[64*i+32+:32] = scheduled[64*step[23:16]+32+:32];
          cycle = scheduled[64*step[23:16]+:32];
        end else if (!step[31]) begin
          for (turns = 0; turns < INTERVAL; turns = turns + 1) begin
            if (taken[32*(cycle%INTERVAL)+:32] == LANES) cycle = cycle + 1;
          end
          scheduled[64*i+32+:32] = taken[32*(cycle%INTERVAL)+:32];
          taken[32*(cycle%INTERVAL)+:32] = taken[32*(cycle%INTERVAL)+:32] + 1;
        end
        scheduled[64*i+:32] = cycle;
      end
    end
  endfunction
  function integer latency_of(input [1:0] kind);
    latency_of = kind[0] ? LANE_CYCLES - 1 : kind[1] ? 1 : LANE_CYCLES;
  endfunction
  localparam [STEPS*64-1:0] SCHEDULE = scheduled(0);

  function integer begin_of(input integer step);
    begin_of = SCHEDULE[64*step+:32];
  endfunction
  // The first cycle in which a value is in a register. Values of lanes can be taken one before.
  function integer held_from(input integer value);
    reg [1:0] kind;
    begin
      kind = kind_of(value < STEPS ? value : 0);
      held_from = value >= STEPS ? 0 : begin_of(value) + latency_of(kind) + (kind == 2'd2 ? 0 : 1);
    end
  endfunction
  function integer value_of(input integer source);
    value_of = source >= INPUT ? STEPS + source - INPUT : source;
  endfunction
  // The register, counted from the first, that has it then; -1: it leaves the lane.
  function integer place_of(input integer value, input integer cycle);
    place_of = cycle < held_from(value) ? -1 : (cycle - held_from(value)) / INTERVAL;
  endfunction

  function integer depth(input integer unused);
    integer i;
    begin
      depth = 0;
      for (i = 0; i < STEPS; i = i + 1) begin
        if (KEPT[i] && held_from(i) > depth) depth = held_from(i);
      end
    end
  endfunction
  localparam DEPTH = depth(0);
  localparam LONGEST = DEPTH / INTERVAL + 1;

  // Registers of a value: as far as its last step takes it.
  function integer places_of(input integer value);
    reg [31:0] step;
    integer i, port, source;
    begin
      places_of = 0;
      for (i = 0; i < STEPS; i = i + 1) begin
        step = step_of(i);
        for (port = 0; port < 3; port = port + 1) begin
          source = {24'b0, step[8*port+:8]};
          if (source < CONSTANT && value_of(source) == value &&
              place_of(value, begin_of(i)) + 1 > places_of)
            places_of = place_of(value, begin_of(i)) + 1;
        end
      end
      if (value < STEPS && KEPT[value<STEPS?value : 0] && place_of(value, DEPTH) + 1 > places_of)
        places_of = place_of(value, DEPTH) + 1;
      if (value == STEPS + INPUTS) places_of = place_of(value, DEPTH) + 1;
    end
  endfunction

  wire [31:0] turn = {24'b0, phase};

  // Values as they come, and in their registers. The last value is that the item is there.
  wire [VALUES*32-1:0] comes;
  wire unused_values = &{1'b0, comes};  // some steps are made for their operands
  wire [VALUES*LONGEST*32-1:0] waits;
  assign comes[(STEPS+INPUTS)*32+:32] = {31'b0, begins};
  assign comes[STEPS*32+:INPUTS*32] = inputs;
  genvar v, s, p, l;
  generate
    for (v = 0; v < VALUES; v = v + 1) begin : value
      localparam PLACES = places_of(v);
      localparam LAST_PHASE = (held_from(v) + INTERVAL - 1) % INTERVAL;
      if (PLACES > 0) begin : registers
        reg [PLACES*32-1:0] held;
        if (PLACES > 1) begin : several
          always @(posedge clock)
            if (turn == LAST_PHASE) held <= {held[(PLACES-1)*32-1:0], comes[v*32+:32]};
        end else begin : one
          always @(posedge clock) if (turn == LAST_PHASE) held <= comes[v*32+:32];
        end
        assign waits[v*LONGEST*32+:PLACES*32] = held;
      end
      if (PLACES < LONGEST) begin : none
        assign waits[(v*LONGEST+PLACES)*32+:(LONGEST-PLACES)*32] = 0;
      end
    end

    // Operands of each step, in its cycle.
    for (s = 0; s < STEPS; s = s + 1) begin : step
      localparam [31:0] STEP = step_of(s);
      wire [95:0] words;
      for (p = 0; p < 3; p = p + 1) begin : port  // c, b, a
        localparam SOURCE = {24'b0, STEP[8*p+:8]};
        localparam VALUE = value_of(SOURCE);
        localparam PLACE = SOURCE < CONSTANT ? place_of(VALUE, begin_of(s)) : 0;
        wire [31:0] word;
        if (SOURCE >= CONSTANT) begin : fixed
          assign word = NUMBERS[(SOURCE-CONSTANT)*32+:32];
        end else if (PLACE < 0) begin : leaving
          assign word = comes[VALUE*32+:32];
        end else begin : waiting
          assign word = waits[(VALUE*LONGEST+PLACE)*32+:32];
        end
        wire negated = (p == 2 & STEP[28]) | (p == 0 & STEP[27]);
        assign words[(2-p)*32+:32] = {word[31] ^ negated, word[30:0]};
      end
      assign operands[s*128+:128] = {31'b0, turn == begin_of(s) % INTERVAL, words};
      if (STEP[31] & ~STEP[30]) begin : is_outside
        assign comes[s*32+:32] = outside[s*32+:32];
      end else begin : is_lane
        localparam LANE = SCHEDULE[64*s+32+:32];
        assign comes[s*32+:32] = STEP[30] ? products[LANE*32+:32] : sums[LANE*32+:32];
        wire unused = &{1'b0, outside[s*32+:32]};
      end
      if (KEPT[s]) begin : is_kept
        assign kept[s*32+:32] = waits[(s*LONGEST+place_of(s, DEPTH))*32+:32];
      end else begin : goes
        assign kept[s*32+:32] = 0;
      end
    end
  endgenerate
  assign ends = turn == DEPTH % INTERVAL &
      waits[((STEPS+INPUTS)*LONGEST+place_of(STEPS + INPUTS, DEPTH))*32];

  // The step that a lane begins in a phase; STEPS for none.
  function integer step_at(input integer lane, input integer at);
    integer i;
    begin
      step_at = STEPS;
      for (i = 0; i < STEPS; i = i + 1) begin
        if (!PROGRAM[(STEPS-1-i)*32+31] && SCHEDULE[64*i+32+:32] == lane &&
            begin_of(i) % INTERVAL == at)
          step_at = i;
      end
    end
  endfunction
  wire [LANES*32-1:0] products, sums;
  generate
    for (l = 0; l < LANES; l = l + 1) begin : lanes
      wire [INTERVAL*128-1:0] of_phase;
      for (p = 0; p < INTERVAL; p = p + 1) begin : of_turn
        localparam STEP = step_at(l, p);
        if (STEP < STEPS) begin : taken
          assign of_phase[p*128+:128] = {31'b0, PROGRAM[(STEPS-1-STEP)*32+29], operands[STEP*128+:96]};
        end else begin : idle
          assign of_phase[p*128+:128] = 0;
        end
      end
      wire [96:0] taken = of_phase[turn[PHASE_BITS-1:0]*128+:97];
      fp32_lane one (
          .clock(clock),
          .a(taken[31:0]),
          .b(taken[63:32]),
          .c(taken[95:64]),
          .unrounded(taken[96]),
          .product(products[l*32+:32]),
          .sum(sums[l*32+:32])
      );
    end
  endgenerate
endmodule
