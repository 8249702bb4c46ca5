// A datapath's depth, registers and multiplexers from the schedule of its steps on its lanes.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "algorithm/splat/folded_pipeline.h"
#include "tlm/datapath.h"

namespace sgs {

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
