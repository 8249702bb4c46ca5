// A request to a channel: a run of bursts in one row of one bank.
#pragma once

#include <cstdint>

#include "tlm/traffic_counters.h"

namespace sgs {

struct ChannelRequest {
  Direction direction = Direction::kRead;
  std::uint8_t region = 0;
  std::uint32_t rank = 0;
  std::uint32_t bank = 0;
  std::uint32_t row = 0;
  std::uint32_t burst = 0;   // first burst in the row
  std::uint32_t bursts = 1;  // how many, contiguous
  bool urgent = false;       // goes before all that are not
  bool masked = false;       // a write that leaves some bytes of its bursts as they are
  void* owner = nullptr;     // handed back with the completion
};

}  // namespace sgs
