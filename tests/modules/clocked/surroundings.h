// What stands before and behind a unit and its clocked reference: a source that offers its items
// and a sink that takes what comes, each at a pace of its own, the same for both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "testbench/units/unit_bench.h"
#include "tests/modules/clocked/clocked_fifo.h"

namespace sgs::test {

// What a sink took, and when.
struct Taken {
  std::uint64_t cycle = 0, what = 0;
};
using Takings = std::vector<Taken>;

// Cycles from an item to the one behind it, at least 1.
class Pace {
 public:
  Pace() = default;
  // One in `one_in` items waits for up to `longest` cycles.
  Pace(std::uint64_t seed, std::uint32_t one_in, std::uint32_t longest) {
    std::mt19937_64 random(seed);
    for (std::uint32_t& gap : gaps_) {
      gap = random() % one_in == 0 ? 1 + static_cast<std::uint32_t>(random() % longest) : 1;
    }
  }
  std::uint32_t gap(std::size_t item) const { return gaps_[item % gaps_.size()]; }

 private:
  std::vector<std::uint32_t> gaps_ = std::vector<std::uint32_t>(1009, 1);
};

template <class T>
class ClockedSource {
 public:
  ClockedSource(std::vector<T> items, const Pace& pace)
      : items_(std::move(items)), pace_(pace), wait_(pace.gap(0)) {}

  void step(ClockedFifo<T>& to) {
    if (wait_ > 0) {
      --wait_;
      return;
    }
    if (at_ == items_.size() || !to.has_room()) return;
    to.put(items_[at_++]);
    wait_ = pace_.gap(at_) - 1;
  }

 private:
  const std::vector<T> items_;
  const Pace pace_;
  std::size_t at_ = 0;
  std::uint32_t wait_;
};

template <class T>
class ClockedSink {
 public:
  explicit ClockedSink(const Pace& pace) : pace_(pace), wait_(pace.gap(0)) {}

  // what_of: as add_sink()'s.
  template <class WhatOf>
  void step(ClockedFifo<T>& from, std::uint64_t now, const WhatOf& what_of) {
    if (wait_ > 0) {
      --wait_;
      return;
    }
    if (!from.can_take()) return;
    taken_.push_back({now, what_of(from.take())});
    wait_ = pace_.gap(taken_.size()) - 1;
  }
  void step(ClockedFifo<T>& from, std::uint64_t now) {
    step(from, now, [](const T& what) { return what; });
  }
  const Takings& taken() const { return taken_; }

 private:
  const Pace pace_;
  std::uint32_t wait_;
  Takings taken_;
};

// The same as threads of a bench.
template <class T>
void add_source(tb::UnitBench& bench, const std::string& name, std::vector<T> items,
                const Pace& pace, TimedFifo<T>& to) {
  bench.add_thread(name, [&bench, &to, pace, items = std::move(items)](Activity& activity) {
    for (std::size_t at = 0; at < items.size(); ++at) {
      bench.clock().wait_cycles(pace.gap(at));
      to.push(items[at], activity);
    }
  });
}
// what_of: of an entry, to tell them apart.
template <class T, class WhatOf>
void add_sink(tb::UnitBench& bench, const std::string& name, std::size_t items, const Pace& pace,
              TimedFifo<T>& from, Takings& taken, const WhatOf& what_of) {
  bench.add_thread(name, [&bench, &from, &taken, items, pace, what_of](Activity& activity) {
    for (std::size_t at = 0; at < items; ++at) {
      bench.clock().wait_cycles(pace.gap(at));
      const std::uint64_t what = what_of(from.pop(activity));
      taken.push_back({bench.clock().now_cycles(), what});
    }
  });
}

}  // namespace sgs::test
