// A unit's port to memory register by register: transactions leave one behind the other, a write
// for as many cycles as it has words; registers lie on the path in each direction; the words of
// answers come back one a cycle. The memory takes a transaction a cycle and answers each after the
// same time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "tlm/memory_port.h"

namespace sgs::test {

struct PortHardware {
  MemoryPortConfig config;
  std::uint32_t read_latency = 40, write_latency = 150;  // of the memory, cycles
};

// Neighbouring bytes that are read or written, as far as they have not left.
struct ClockedTransfer {
  std::uint64_t address = 0, bytes = 0;
  std::uint64_t answers = 0;  // reads that the port has had answered when these are
};

class ClockedPort {
 public:
  explicit ClockedPort(const PortHardware& hardware) : hw_(hardware) {}

  // Before whoever asks is stepped: answers come first, and make room.
  void begin_cycle() {
    ++now_;
    while (!writes_.empty() && writes_.front() == now_) writes_.pop_front();
    if (reads_.empty() || now_ < reads_.front().due) return;
    if (now_ < last_word_ + reads_.front().words) return;
    last_word_ = now_;
    reads_.pop_front();
    ++answers_;
  }

  // The next transaction leaves if it can. Whether all of them have.
  bool read(ClockedTransfer& what) {
    if (what.bytes == 0) return true;
    if (!can_leave()) return false;
    const std::uint64_t words = next_words(what);
    leaves_from_ = now_ + 1;
    reads_.push_back({now_ + 2 * hw_.config.path_cycles + hw_.read_latency, words});
    what.answers = ++asked_;
    return what.bytes == 0;
  }
  bool write(ClockedTransfer& what) {
    if (what.bytes == 0) return true;
    if (!can_leave() || writes_.size() == hw_.config.max_writes) return false;
    const std::uint64_t words = next_words(what);
    leaves_from_ = now_ + words;
    writes_.push_back(now_ + words - 1 + 2 * hw_.config.path_cycles + hw_.write_latency);
    return what.bytes == 0;
  }

  // The last word of a read is there.
  bool answered(const ClockedTransfer& read) const {
    return read.bytes == 0 && read.answers <= answers_;
  }
  bool idle() const { return reads_.empty() && writes_.empty(); }
  // Words of a write are leaving.
  bool sending() const { return now_ < leaves_from_; }
  std::uint64_t words(std::uint64_t bytes) const {
    return (bytes + hw_.config.width_bytes - 1) / hw_.config.width_bytes;
  }

 private:
  struct Read {
    std::uint64_t due;  // not earlier at the port
    std::uint64_t words;
  };

  bool can_leave() const {
    return now_ >= leaves_from_ && reads_.size() + writes_.size() < hw_.config.max_outstanding;
  }
  // Up to the next multiple of the longest transaction.
  std::uint64_t next_words(ClockedTransfer& what) const {
    const std::uint64_t longest = hw_.config.max_transaction_bytes;
    const std::uint64_t bytes = std::min(what.bytes, longest - what.address % longest);
    what.address += bytes;
    what.bytes -= bytes;
    return words(bytes);
  }

  const PortHardware hw_;
  std::uint64_t now_ = ~std::uint64_t{0}, leaves_from_ = 0, last_word_ = 0;
  std::uint64_t asked_ = 0, answers_ = 0;  // reads
  std::deque<Read> reads_;
  std::deque<std::uint64_t> writes_;  // when each is answered
};

}  // namespace sgs::test
