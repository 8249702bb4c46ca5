// When an HFU does what, as recurrences over its shares, slices and candidates: a second account of
// its timing, without threads and events. It holds while input and memory never wait for anything
// but their latency and sorting always has room.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "algorithm/memory/regions.h"
#include "algorithm/splat/coarse_bound_by.h"
#include "modules/streaminggs/hfu/hfu_config.h"

namespace sgs::tb {

struct TimedShare {
  std::vector<bool> passes;                 // [Gaussian] the coarse filter
  std::vector<std::uint32_t> lines;         // [Gaussian] of the codebook buffer, where there is one
  RecordArray first_halves, second_halves;  // in the memory
  std::uint32_t first = 0;                  // slot of Gaussian 0
  // Cycle from which on the filters see that the share's group is finished.
  std::uint64_t finished_from = std::numeric_limits<std::uint64_t>::max();
};

struct HfuTimes {
  std::vector<std::uint64_t> shares_done;  // [share] cycle in which its mark goes to sorting
  std::vector<std::vector<bool>> tested;   // [share][Gaussian] by the fine filter
  // Busy cycles; turns: of these, those that a test waited for its turn at the lanes.
  std::uint64_t coarse_busy = 0, decode_busy = 0, fine_busy = 0;
  std::uint64_t coarse_turns = 0, fine_turns = 0;
  std::uint64_t lines = 0;  // of the codebook buffer that were read
  std::uint64_t first_halves = 0, coarse_tests = 0, coarse_passed = 0;
  std::uint64_t second_halves = 0, decoded = 0, fine_tests = 0;
  std::uint64_t dropped = 0;  // their group was finished
};

// All shares wait at the input with a latency of one cycle; memory answers after latency_cycles, a
// transaction leaves a port every cycle.
// decode_latency_cycles: of the stage that quantised second halves pass before the FFU; the
// codebook buffer is full from the start and has no other reader. None where they are not
// quantised.
HfuTimes hfu_times(const HfuConfig& config, CoarseBoundBy bound_by,
                   const std::vector<TimedShare>& shares, std::uint64_t latency_cycles,
                   std::optional<std::uint32_t> decode_latency_cycles);

}  // namespace sgs::tb
