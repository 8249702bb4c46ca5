// A resource that does one thing at a time, for users who ask in the order of a program and not of
// time: each window of its time has room for as much work as it is long. What comes when a window
// is part taken goes behind that part; when exactly the others came is not kept.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sgs {

class BookedTime {
 public:
  // window: cycles.
  explicit BookedTime(std::uint64_t window) : window_(window) {}

  // Work that can begin in cycle `from`: the cycle in which it ends.
  std::uint64_t book(std::uint64_t from, std::uint64_t work) {
    busy_ += work;
    std::uint64_t at = from;
    while (work > 0) {
      const std::size_t w = free_window(at / window_);
      const std::uint64_t begin = w * window_;
      at = std::max(at, begin + used_[w]);
      const std::uint64_t taken = std::min(work, begin + window_ - at);
      used_[w] += static_cast<std::uint32_t>(taken);
      work -= taken;
      at += taken;
    }
    return at;
  }
  std::uint64_t busy_cycles() const { return busy_; }

 private:
  // The first from `w` on that is not full.
  std::size_t free_window(std::size_t w) {
    if (w >= used_.size()) {
      used_.resize(2 * w + 1);
      next_.resize(used_.size());
    }
    std::size_t at = w;
    while (at < used_.size() && used_[at] == window_) at += 1 + next_[at];
    if (at >= used_.size()) return free_window(at);
    if (at > w && used_[w] == window_) next_[w] = static_cast<std::uint32_t>(at - w - 1);
    return at;
  }

  const std::uint64_t window_;
  std::vector<std::uint32_t> used_;  // [window] of its cycles
  std::vector<std::uint32_t> next_;  // [window] full ones that are known to follow
  std::uint64_t busy_ = 0;
};

}  // namespace sgs
