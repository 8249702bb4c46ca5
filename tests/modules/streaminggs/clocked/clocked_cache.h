// A small cache, four ways a set, least recently used first to go, by tags alone; and one whose
// port many share, a look-up a cycle, with lines on their way from memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

class ClockedCache {
 public:
  static constexpr std::uint32_t kLineBytes = 32, kWays = 4;

  explicit ClockedCache(std::uint32_t bytes)
      : sets_(std::max(1U, bytes / (kLineBytes * kWays)), std::vector<Way>(kWays)) {}

  bool hits(std::uint64_t line) {
    for (Way& way : set_of(line)) {
      if (way.line != line) continue;
      way.used = ++uses_;
      return true;
    }
    return false;
  }
  void fill(std::uint64_t line) {
    std::vector<Way>& set = set_of(line);
    *std::min_element(set.begin(), set.end(),
                      [](const Way& a, const Way& b) { return a.used < b.used; }) = {line, ++uses_};
  }

 private:
  struct Way {
    std::uint64_t line = ~std::uint64_t{0}, used = 0;
  };
  std::vector<Way>& set_of(std::uint64_t line) { return sets_[line % sets_.size()]; }

  std::vector<std::vector<Way>> sets_;
  std::uint64_t uses_ = 0;
};

class ClockedSharedCache {
 public:
  // lines: at most so many on their way.
  ClockedSharedCache(std::uint32_t bytes, const PortHardware& port, std::uint32_t lines)
      : lines_(lines), port_(port), cache_(bytes) {}

  // From this cycle on somebody waits for a turn to look up a line. called: it was, and a place is
  // kept for it.
  void ask(std::size_t who, std::uint64_t line, bool called = false) {
    look_ups_.push_back({who, line, false, called});
  }
  // Who waits longest for a place that is free now: to ask again in the next cycle, or, where a
  // line has come, in this one.
  std::optional<std::size_t> call() {
    if (!leaves_place_ || without_place_.empty()) return {};
    leaves_place_ = false;
    ++kept_;
    const std::size_t who = without_place_.front();
    without_place_.pop_front();
    return who;
  }
  bool idle() const { return look_ups_.empty() && fetches_.empty(); }

  void forget_who_waits() {
    look_ups_.clear();
    without_place_.clear();
    kept_ = 0;
    for (Fetch& fetch : fetches_) fetch.waiting.clear();
  }

  // A line that had come by the last edge, at most one a cycle; who waits for it reads it when it
  // has a turn.
  void lines_come() {
    leaves_place_ = false;
    const bool come = !fetches_.empty() && port_.answered(fetches_.front().read);
    port_.begin_cycle();
    if (!come) return;
    cache_.fill(fetches_.front().line);
    for (const std::size_t who : fetches_.front().waiting) {
      look_ups_.push_back({who, fetches_.front().line, true, false});
    }
    fetches_.pop_front();
    leaves_place_ = true;
  }
  // A turn: who has its line, if any. One that waits already is not asked for again.
  std::optional<std::size_t> look_up() {
    if (look_ups_.empty()) return {};
    const LookUp at = look_ups_.front();
    look_ups_.pop_front();
    kept_ -= at.called ? 1 : 0;
    leaves_place_ = at.called;
    if (at.has_come || cache_.hits(at.line)) return at.who;
    auto fetch = std::find_if(fetches_.begin(), fetches_.end(),
                              [&](const Fetch& f) { return f.line == at.line; });
    if (fetch == fetches_.end()) {
      leaves_place_ = false;
      if (fetches_.size() + kept_ == lines_) {
        without_place_.push_back(at.who);
        return {};
      }
      fetch = fetches_.insert(fetch, {at.line, {at.line * ClockedCache::kLineBytes, 1}, {}});
      port_.read(fetch->read);
    }
    fetch->waiting.push_back(at.who);
    return {};
  }

 private:
  struct LookUp {
    std::size_t who;
    std::uint64_t line;
    bool has_come, called;
  };
  struct Fetch {
    std::uint64_t line;
    ClockedTransfer read;
    std::vector<std::size_t> waiting;
  };

  const std::uint32_t lines_;
  ClockedPort port_;  // with room for all lines
  ClockedCache cache_;
  std::deque<std::size_t> without_place_;
  std::size_t kept_ = 0;       // places, for those that were called
  bool leaves_place_ = false;  // that nobody is called for yet
  std::deque<LookUp> look_ups_;
  std::deque<Fetch> fetches_;
};

}  // namespace sgs::test
