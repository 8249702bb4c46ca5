// A datapath: lanes of one precision with the parts beside them, and the operations that one item
// takes of each. Time, area and energy of the unit's arithmetic all follow from this one struct.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sgs {

// Operations of an item that no lane does: comparisons, look-ups.
struct BesideLanes {
  std::string kind;  // part that does them: a row of the technology table
  std::uint32_t operations = 0;
  std::uint32_t built_for = 0;  // parts that stand in a copy at least: for items of other kinds
};

// Hardware between the lanes of one copy and the parts beside them, in bits: registers that hold
// values until they are taken, and two-way multiplexers at the inputs. `written` and `selected` are
// the bits that one item writes and passes.
struct BetweenLanes {
  std::uint32_t registers = 0, multiplexers = 0;
  std::uint32_t written = 0, selected = 0;
};

// From the arrival of values that are read when they are needed to the end of what depends on
// them, in cycles of an item.
struct DatapathLoop {
  std::uint32_t arrival = 0, end = 0;

  std::uint32_t cycles() const { return end - arrival; }
};

inline std::uint32_t longest_of(const std::vector<DatapathLoop>& loops) {
  std::uint32_t longest = 0;
  for (const DatapathLoop& loop : loops) longest = std::max(longest, loop.cycles());
  return longest;
}

struct Datapath {
  std::string name;       // what it does to an item: "coarse", "chunk_test"
  std::string component;  // whose square millimetres and joules
  std::string lane;       // row of the technology table: "fp32_lane", "fp16_lane"
  std::string lanes_of;   // datapath whose lanes these are, idle meanwhile; empty: lanes of its own
  // Lanes that serve one item, each a multiply-accumulate a cycle, and how often these stand there,
  // side by side.
  std::uint32_t lanes = 1, copies = 1;
  // Multiply-accumulates of an item: charged, in time and energy; counted by running it, and
  // published by the paper (0: not).
  std::uint32_t used_macs = 0, counted_macs = 0, published_macs = 0;
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // by class of operation
  std::vector<BesideLanes> beside;
  BetweenLanes between;
  std::uint32_t set_bits = 0;  // bits of registers that all copies read: numbers of frame, group
  std::uint32_t depth_cycles = 0;   // latency of an item from beginning to end
  std::vector<DatapathLoop> loops;  // of values that come together

  // The part of this kind; a new one without operations where there is none yet.
  BesideLanes& part_of(const std::string& kind) {
    for (BesideLanes& part : beside) {
      if (part.kind == kind) return part;
    }
    return beside.emplace_back(BesideLanes{kind, 0, 0});
  }

  std::uint64_t all_lanes() const { return std::uint64_t{lanes} * copies; }

  std::uint32_t loop_cycles() const { return longest_of(loops); }

  // Cycles that the lanes of one copy are busy with an item: the next can start so much later.
  std::uint64_t interval_cycles() const { return (used_macs + std::uint64_t{lanes} - 1) / lanes; }

  // Parts of this kind that stand in all copies: each does an operation a cycle, together they keep
  // pace with the lanes.
  std::uint64_t parts(const BesideLanes& of) const {
    const std::uint64_t at_full_rate = std::uint64_t{of.operations} * lanes;
    return copies *
           std::max<std::uint64_t>(of.built_for, (at_full_rate + used_macs - 1) / used_macs);
  }

  // Builds the datapath so that it also takes items of another kind: the larger need of each part.
  void build_also_for(const Datapath& other) {
    for (const BesideLanes& of : other.beside) {
      BesideLanes& own = part_of(of.kind);
      const auto parts_of_copy = static_cast<std::uint32_t>(other.parts(of) / other.copies);
      own.built_for = std::max(own.built_for, parts_of_copy);
    }
    between.registers = std::max(between.registers, other.between.registers);
    between.multiplexers = std::max(between.multiplexers, other.between.multiplexers);
    set_bits = std::max(set_bits, other.set_bits);
  }

  // Fewest cycles of so many items in all copies.
  std::uint64_t cycles(std::uint64_t items) const {
    return (items + copies - 1) / copies * interval_cycles();
  }
};

}  // namespace sgs
