// A datapath from what was counted by running its code, and its depth, registers and multiplexers
// from the schedule of its steps on its lanes.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "modules/datapath/folded_pipeline.h"
#include "tlm/datapath.h"

namespace sgs {

// Single precision, charged with what was counted, one lane until it is said otherwise. Beside the
// lanes stand comparators, and tables: for what reciprocals, roots and logarithms start from, and
// for what the code looks up (rows: their kind).
inline Datapath counted_datapath(const char* name, const char* component, const OperationCounts& c,
                                 const char* rows = "small_table") {
  Datapath path;
  path.name = name;
  path.component = component;
  path.lane = "fp32_lane";
  path.used_macs = path.counted_macs = folded_macs(c);
  path.counts = {{"multiplies", c.multiplies},
                 {"adds", c.adds},
                 {"fused", c.fused},
                 {"divisions", c.divisions},
                 {"divisors", c.divisors},
                 {"square_roots", c.square_roots},
                 {"logarithms", c.logarithms},
                 {"exponentials", c.exponentials},
                 {"comparisons", c.comparisons},
                 {"roundings", c.roundings},
                 {"splits", c.splits},
                 {"scalings", c.scalings},
                 {"conversions", c.conversions},
                 {"index_adds", c.index_adds},
                 {"look_ups", c.look_ups}};
  const std::pair<const char*, std::uint32_t> beside[] = {
      {"comparator", comparisons(c)}, {"small_table", seeds(c)}, {rows, c.look_ups}};
  for (const auto& [kind, operations] : beside) {
    if (operations > 0) path.part_of(kind).operations += operations;
  }
  return path;
}

constexpr std::uint32_t kSingleBits = 32, kHalfBits = 16;

// The lanes of one copy, what stands beside them, and an item every so many cycles.
inline FoldedParts parts_of(const Datapath& path, std::uint32_t interval_cycles) {
  FoldedParts parts;
  parts.lanes = path.lanes;
  parts.interval_cycles = interval_cycles;
  for (const BesideLanes& beside : path.beside) {
    const auto in_copy = static_cast<std::uint32_t>(path.parts(beside) / path.copies);
    (beside.kind == "comparator" ? parts.comparators : parts.tables) += in_copy;
  }
  return parts;
}

inline BetweenLanes between_lanes(const LaneWiring& wiring, std::uint32_t value_bits) {
  return {value_bits * wiring.register_words, value_bits * wiring.select_words,
          value_bits * wiring.words_written, value_bits * wiring.words_selected};
}

// Lanes, copies and charge must be what they will be. value_bits: of a value between two steps.
// Throws std::logic_error where the steps take more lanes than there are, unless the charge is a
// published one, which may be less than was counted.
inline void schedule(Datapath& path, const std::vector<LaneStep>& steps,
                     const OperationLatencies& latencies, std::uint32_t value_bits = kSingleBits) {
  const auto interval = static_cast<std::uint32_t>(path.interval_cycles());
  const FoldedPipeline folded = folded_pipeline(steps, parts_of(path, interval), latencies);
  if (path.used_macs == path.counted_macs && folded.parts.lanes > path.lanes) {
    throw std::logic_error(path.name + ": its steps take more lanes than are charged");
  }
  path.between = between_lanes(folded.wiring, value_bits);
  path.depth_cycles = folded.schedule.cycles;
  path.loop_cycles = folded.schedule.loop_cycles;
}

// Registers for the constants of the steps: of the group that is worked on and of the next, which
// is set meanwhile; each copy takes the one or the other, since items of both may be under way.
// Those of the code itself, wires, are counted among them.
inline void set_by_group(Datapath& path, const std::vector<LaneStep>& steps) {
  const std::uint32_t bits = kSingleBits * constants_of(steps);
  path.set_bits = 2 * bits;
  path.between.multiplexers += bits;
}

}  // namespace sgs
