// Rows of pixels that leave through a port from the one register that they are made in. While the
// words of a row leave, the next row takes their places, as long as it is made no faster than they
// leave. It stands still where the rest of the row cannot leave.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tlm/activity.h"
#include "tlm/memory_access.h"
#include "tlm/memory_port.h"

namespace sgs {

class RowWriter {
 public:
  RowWriter(MemoryPort& port, Activity& activity) : port_(port), activity_(activity) {}

  // A row is made in so many cycles, less those that passed while the one before it left.
  void make(std::uint64_t cycles) {
    activity_.work(cycles - made_);
    made_ = 0;
  }

  // The row leaves; the last of its transactions is on its way when this returns. next_cycles: of
  // the row behind it, 0 for none.
  void write(std::uint64_t address, const std::byte* from, std::uint32_t bytes, std::uint8_t region,
             std::uint64_t next_cycles) {
    const std::uint32_t longest = port_.config().max_transaction_bytes;
    const bool follows = next_cycles >= words(bytes);
    while (true) {
      const auto length =
          static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes, longest - address % longest));
      start_write(port_, activity_, address, from, length, region);
      if (length == bytes) return;
      address += length;
      from += length;
      bytes -= length;
      const std::uint64_t cycles = follows ? std::min(words(length), next_cycles - made_) : 0;
      activity_.work(cycles);
      made_ += cycles;
    }
  }

 private:
  std::uint64_t words(std::uint64_t bytes) const {
    const std::uint64_t width = port_.config().width_bytes;
    return (bytes + width - 1) / width;
  }

  MemoryPort& port_;
  Activity& activity_;
  std::uint64_t made_ = 0;  // cycles of the next row
};

}  // namespace sgs
