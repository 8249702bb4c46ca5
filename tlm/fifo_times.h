// A TimedFifo without a kernel: entries pass it in the order of the program, and their cycles
// follow from each other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace sgs {

class FifoTimes {
 public:
  // As TimedFifo.
  explicit FifoTimes(std::uint32_t capacity, std::uint32_t latency_cycles = 1)
      : latency_(latency_cycles), entries_(capacity) {}

  // The cycle in which an entry that is there in `now` goes in: there must be room. The one that it
  // takes the place of has been removed by the program.
  std::uint64_t push(std::uint64_t now) {
    Entry& entry = entries_[place(pushed_)];
    const std::uint64_t at = std::max(now, entry.removed);
    entry.ready = at + latency_;
    ++pushed_;
    return at;
  }
  // From `now` on a place is taken for the latency, as by an entry, but none comes of it.
  void hold_place(std::uint64_t now) { held_until_.push_back(now + latency_); }
  // The first cycle from `now` on, which does not go back, with room for an entry beside the places
  // that are held.
  std::uint64_t room(std::uint64_t now) {
    while (true) {
      while (!held_until_.empty() && held_until_.front() <= now) held_until_.pop_front();
      const std::uint64_t held = held_until_.size();
      if (held == 0) return std::max(now, entries_[place(pushed_)].removed);
      if (held < entries_.size() && entries_[place(pushed_ + held)].removed <= now) return now;
      now = held < entries_.size()
                ? std::min(entries_[place(pushed_ + held)].removed, held_until_.front())
                : held_until_.front();
    }
  }
  // The cycle in which a reader that looks in `now` has the oldest entry, which stays until it is
  // removed.
  std::uint64_t front(std::uint64_t now) const {
    return std::max(now, entries_[place(removed_)].ready);
  }
  void remove(std::uint64_t now) { entries_[place(removed_++)].removed = now; }
  std::uint64_t pop(std::uint64_t now) {
    const std::uint64_t at = front(now);
    remove(at);
    return at;
  }
  std::uint64_t pushed() const { return pushed_; }

 private:
  struct Entry {
    std::uint64_t ready = 0, removed = 0;
  };
  std::size_t place(std::uint64_t number) const { return number % entries_.size(); }

  const std::uint64_t latency_;
  std::vector<Entry> entries_;            // ring
  std::deque<std::uint64_t> held_until_;  // places
  std::uint64_t pushed_ = 0, removed_ = 0;
};

}  // namespace sgs
