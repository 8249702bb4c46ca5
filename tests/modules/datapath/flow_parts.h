// What tests of datapaths make of data flows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "modules/datapath/lane_steps.h"

namespace sgs::test {

constexpr OperationLatencies kLatencies{3, 1, 1};

inline std::uint32_t macs(const FlowPart& part) { return folded_macs(part.counts()); }

// A copy of nodes [first, last) of a flow that is a test's own.
inline FlowPart part_of(const DataFlow& flow, std::size_t first, std::size_t last,
                        std::vector<std::vector<std::uint32_t>> together = {}) {
  return {std::make_shared<DataFlow>(flow), first, last, std::move(together)};
}

}  // namespace sgs::test
