// A memory as an estimate knows it: when it would answer, without bytes and without a kernel.
#pragma once

#include <cstdint>

#include "tlm/counters.h"

namespace sgs {

class MemoryEstimate {
 public:
  virtual ~MemoryEstimate() = default;

  struct Transaction {
    Direction direction;
    std::uint8_t requester, region;
    std::uint64_t address;
    std::uint32_t bytes;
  };
  // The cycle of the machine's clock in which one that comes to the memory in `cycle` is answered.
  // They may come in any order.
  virtual std::uint64_t answered(std::uint64_t cycle, const Transaction& transaction) = 0;
};

}  // namespace sgs
