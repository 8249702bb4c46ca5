// When an HFU does what, as recurrences over its shares, slices and candidates: a second account of
// its timing, without threads and events. It holds while input and memory never wait for anything
// but their latency and sorting always has room.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "modules/hfu/hfu_config.h"

namespace sgs::tb {

struct HfuTimes {
  std::vector<std::uint64_t> shares_done;  // [share] cycle in which its mark goes to sorting
  std::uint64_t coarse_busy = 0, decode_busy = 0, fine_busy = 0;
};

// The stage before the FFU that quantised second halves pass. The codebook buffer is full from the
// start and has no other reader.
struct DecodeTiming {
  std::uint32_t latency_cycles = 0;
  std::vector<std::vector<std::uint32_t>> lines;  // [share][Gaussian] read for its record
};

// passes: [share][Gaussian] whether it passes the coarse filter. All shares wait at the input with
// a latency of one cycle; memory answers after latency_cycles. decode: none where second halves are
// not quantised.
HfuTimes hfu_times(const HfuConfig& config, const std::vector<std::vector<bool>>& passes,
                   std::uint64_t latency_cycles, const std::optional<DecodeTiming>& decode);

}  // namespace sgs::tb
