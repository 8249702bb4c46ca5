// The maker of groups' numbers as a unit's schedule has it.
#pragma once

#include "modules/datapath/group_numbers.h"
#include "tests/modules/clocked/clocked_group_numbers.h"

namespace sgs::test {

inline GroupNumbersHardware hardware_of(GroupUse use) {
  const GroupNumbers made = group_numbers(group_flow(use), OperationLatencies{});
  return {made.interval_cycles, made.depth_cycles};
}

}  // namespace sgs::test
