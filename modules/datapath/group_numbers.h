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

}  // namespace sgs
