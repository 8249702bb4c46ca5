// A resource that does one thing at a time, first come first served, for users who ask in the order
// of a program and not of time. Windows of its time know how much work came in each and what was
// left over from the one before: that is what whoever comes then waits for. Work that is booked
// later does not move what was answered before, whenever it came: who asks for all it has to do
// should see that it is done in no less time than that (busy_cycles()).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sgs {

class BookedTime {
 public:
  // window: cycles.
  explicit BookedTime(std::uint64_t window) : window_(window), windows_(1) {}

  // Work that can begin in cycle `from`: the cycle in which it ends.
  std::uint64_t book(std::uint64_t from, std::uint64_t work) {
    busy_ += work;
    std::size_t at = from / window_;
    while (windows_.size() <= at) windows_.push_back({left_after(windows_.back()), 0});
    Window& window = windows_[at];
    const std::uint64_t begin = at * window_;
    const std::uint64_t end = std::max(from, begin + window.left + window.came) + work;
    window.came += work;
    while (++at < windows_.size()) {
      const std::uint64_t left = left_after(windows_[at - 1]);
      if (left == windows_[at].left) break;
      windows_[at].left = left;
    }
    return end;
  }
  std::uint64_t busy_cycles() const { return busy_; }

 private:
  struct Window {
    std::uint64_t left = 0, came = 0;  // work: of earlier windows, and its own
  };
  std::uint64_t left_after(const Window& window) const {
    const std::uint64_t work = window.left + window.came;
    return work - std::min(work, window_);
  }

  const std::uint64_t window_;
  std::vector<Window> windows_;  // up to the latest that anything came in
  std::uint64_t busy_ = 0;
};

}  // namespace sgs
