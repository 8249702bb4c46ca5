// A FIFO of registers, as clocked machines have it between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

namespace sgs::test {

// In every cycle readers are stepped before writers: room that a reader makes is seen by the writer
// in the same cycle, as a handshake of ready and valid gives it.
template <class T>
class ClockedFifo {
 public:
  // latency: cycles until an entry that was put in can be taken.
  explicit ClockedFifo(std::size_t capacity, std::uint32_t latency = 1)
      : capacity_(capacity), latency_(latency) {}

  bool can_take() const { return !entries_.empty() && entries_.front().first == 0; }
  bool has_room() const { return entries_.size() < capacity_; }
  std::size_t fill() const { return entries_.size(); }
  const T& front() const { return entries_.front().second; }
  T take() {
    T value = std::move(entries_.front().second);
    entries_.pop_front();
    return value;
  }
  void put(T value) { entries_.emplace_back(latency_, std::move(value)); }

  // The clock's edge: what is on its way comes nearer.
  void step() {
    for (auto& [left, value] : entries_) left -= left > 0 ? 1 : 0;
  }

 private:
  const std::size_t capacity_;
  const std::uint32_t latency_;
  std::deque<std::pair<std::uint32_t, T>> entries_;  // cycles left, and what it is
};

}  // namespace sgs::test
