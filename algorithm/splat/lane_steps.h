// A computation as the steps that the parts of a datapath do: multiply-adds of a lane, operations
// of a comparator, look-ups. What a lane has no hardware for is made of such steps, the same that
// lane_macs.h counts and longest_path.h puts in a row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/data_flow.h"

namespace sgs {

enum class StepBy : std::uint8_t { kOutside, kLane, kComparator, kTable };

struct LaneStep {
  // What one of its inputs takes: a constant's bits, or the value of a step before it.
  struct Source {
    std::uint32_t port;  // 0, 1: the factors of a lane, which can change places; 2: what it adds
    DataFlow::Operand value;
  };

  StepBy by = StepBy::kOutside;
  std::vector<Source> sources;
  bool answers = false;  // a comparison's answer, which is no value
  bool kept = false;     // its value is wanted at the end
  // Of a value from outside: 0 if it is there at the beginning, else the number of those that come
  // together, when the first of them is taken.
  std::uint32_t comes_with = 0;
};

// Steps of nodes [first, last), each behind those that it takes. together: inputs that are read
// when they are needed, those of one list at once; all else from outside is there at the beginning.
std::vector<LaneStep> lane_steps(const DataFlow& flow, std::size_t first, std::size_t last,
                                 const OperationLatencies& latencies,
                                 const std::vector<std::vector<std::uint32_t>>& together = {});

// Different constants that the steps take: numbers of the frame, of the group, and of the code.
std::uint32_t constants_of(const std::vector<LaneStep>& steps);

// Cycles from the sources to the value.
constexpr std::uint32_t cycles_of(StepBy by, const OperationLatencies& latencies) {
  switch (by) {
    case StepBy::kOutside:
      return 0;
    case StepBy::kLane:
      return latencies.lane;
    case StepBy::kComparator:
      return latencies.comparator;
    case StepBy::kTable:
      return latencies.look_up;
  }
  return 0;
}

}  // namespace sgs
