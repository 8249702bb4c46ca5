// A port to a memory that takes a transaction a cycle and answers each after the same time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace sgs::test {

class ClockedPort {
 public:
  // most: transactions that are unanswered at once.
  ClockedPort(std::uint32_t latency, std::size_t most) : latency_(latency), most_(most) {}

  // Before whoever asks is stepped: answers come first, and make room.
  void begin_cycle() {
    sends_ = false;
    for (std::uint32_t& left : unanswered_) --left;
    while (!unanswered_.empty() && unanswered_.front() == 0) {
      unanswered_.pop_front();
      ++answered_;
    }
  }
  bool can_send() const { return !sends_ && unanswered_.size() < most_; }
  // The transaction's number.
  std::uint64_t send() {
    sends_ = true;
    unanswered_.push_back(latency_);
    return sent_++;
  }
  bool answered(std::uint64_t number) const { return number < answered_; }
  std::size_t unanswered() const { return unanswered_.size(); }
  bool idle() const { return unanswered_.empty(); }

 private:
  const std::uint32_t latency_;
  const std::size_t most_;
  bool sends_ = false;                    // in this cycle
  std::deque<std::uint32_t> unanswered_;  // cycles left
  std::uint64_t sent_ = 0, answered_ = 0;
};

// Reads and writes through one port, whose answers come after different times.
class ClockedTwoWayPort {
 public:
  // most: transactions that are unanswered at once, of these writes.
  ClockedTwoWayPort(std::uint32_t read_latency, std::uint32_t write_latency, std::size_t most,
                    std::size_t most_writes)
      : reads_(read_latency, most), writes_(write_latency, most_writes), most_(most) {}

  void begin_cycle() {
    sends_ = false;
    reads_.begin_cycle();
    writes_.begin_cycle();
  }
  bool can_read() const { return !sends_ && has_room(); }
  bool can_write() const { return can_read() && writes_.can_send(); }
  std::uint64_t read() {
    sends_ = true;
    return reads_.send();
  }
  void write() {
    sends_ = true;
    writes_.send();
  }
  bool answered(std::uint64_t read) const { return reads_.answered(read); }
  bool idle() const { return reads_.idle() && writes_.idle(); }

 private:
  bool has_room() const { return reads_.unanswered() + writes_.unanswered() < most_; }

  ClockedPort reads_, writes_;
  const std::size_t most_;
  bool sends_ = false;  // in this cycle
};

}  // namespace sgs::test
