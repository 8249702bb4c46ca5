// Numbers of a pixel group that a unit's lanes take as constants: the hardware that makes them,
// once a group, and when they stand. It has one part of each kind that its operations take, beside
// the unit's lanes.
// Function: algorithm/splat/group_numbers.h. The registers that hold the numbers of two groups are
// those of the lanes that take them (set_by_group).
#pragma once

#include <algorithm>
#include <cstdint>

#include "modules/datapath/lane_steps.h"
#include "tlm/data_sheet.h"

namespace sgs {

// What a unit asks of a group.
enum class GroupUse : std::uint8_t {
  kWalk,    // the sides of its frustum, and where the next group lies
  kFilter,  // the centres of its outer pixels, from its place
  kPixels,  // its pixels, from its place
  kRays     // its pixels, and where the next group lies
};

// Operations of the numbers of one group, recorded by making them. across: columns, and rows, of
// parts that a filter tells apart.
FlowPart group_flow(GroupUse use, std::uint32_t across = 1);

struct GroupNumbers {
  OperationCounts counts;
  std::uint32_t interval_cycles = 1, depth_cycles = 0;  // until the next group; until all stand
  std::uint32_t register_bits = 0, select_bits = 0;     // that are built
  std::uint32_t bits_written = 0, bits_selected = 0;    // of one group

  // groups: made so far.
  void publish(DataSheet& sheet, const char* component, std::uint64_t groups) const;
};
GroupNumbers group_numbers(const FlowPart& flow, const OperationLatencies& latencies);

// Groups one behind the other.
class GroupNumbersInTurn {
 public:
  explicit GroupNumbersInTurn(const GroupNumbers& made) : made_(made) {}

  // The cycle from which on the next group's numbers stand. from: its place is known, and the
  // registers that take them are free.
  std::uint64_t stand(std::uint64_t from) {
    const std::uint64_t begin = std::max(from, free_);
    free_ = begin + made_.interval_cycles;
    ++groups_;
    return begin + made_.depth_cycles;
  }
  std::uint64_t groups() const { return groups_; }
  void publish(DataSheet& sheet, const char* component) const {
    made_.publish(sheet, component, groups_);
  }

 private:
  const GroupNumbers made_;
  std::uint64_t free_ = 0, groups_ = 0;
};

// The numbers of a filter: of the group that is tested and of the one before it, whose tests may be
// under way.
class TestedGroupNumbers {
 public:
  explicit TestedGroupNumbers(const GroupNumbers& made) : in_turn_(made) {}

  // The cycle from which on tests of the group can begin. known: from this cycle on it is.
  std::uint64_t stand(std::uint32_t group, std::uint64_t known) {
    if (group_ == group) return stand_;
    group_ = group;
    set_ = 1 - set_;
    return stand_ = in_turn_.stand(std::max(known, left_[set_]));
  }
  // A test of this group will have left the pipeline in this cycle.
  void leaves(std::uint64_t cycle) { left_[set_] = cycle; }
  void publish(DataSheet& sheet, const char* component) const {
    in_turn_.publish(sheet, component);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  GroupNumbersInTurn in_turn_;
  std::uint32_t group_ = kNone, set_ = 0;
  std::uint64_t stand_ = 0;
  std::uint64_t left_[2] = {};  // [set] the last test that takes it
};

}  // namespace sgs
