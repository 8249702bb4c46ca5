// What stands before and behind a unit and its clocked reference: a source that offers its items
// and a sink that takes what comes, each at a pace of its own, the same for both.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "algorithm/splat/extent_bound.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/finished_subtiles.h"
#include "testbench/units/unit_bench.h"
#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_port.h"

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

// Groups that rendering tells to be finished, one behind the other; before that their sub-tiles,
// row by row. The news is seen in the cycle behind.
struct Finishing {
  std::uint32_t pitch = 0;  // cycles from a group to the next; 0: none is finished
  bool seen(std::uint32_t group, std::uint64_t now) const {
    return pitch > 0 && now > std::uint64_t{pitch} * (group + 1);
  }
  // Cycle in which sub-tile `at` of so many is told of.
  std::uint64_t told(std::uint32_t group, std::size_t at, std::size_t subtiles) const {
    return pitch * (std::uint64_t{group} * subtiles + at) / subtiles;
  }
  // Of all sub-tiles of the reach.
  bool all_seen(std::uint32_t group, const PixelRect& pixels, const GroupReach& reach,
                std::uint64_t now) const {
    const auto columns = subtiles_along(pixels.width()), rows = subtiles_along(pixels.height());
    const auto x = std::min<std::size_t>(reach.x1, columns - 1);
    const auto y = std::min<std::size_t>(reach.y1, rows - 1);
    if (pitch == 0) return false;
    return x < reach.x0 || y < reach.y0 || now > told(group, y * columns + x, columns * rows);
  }
  static std::size_t subtiles_along(int px) {
    return static_cast<std::size_t>((px + kSubtilePx - 1) / kSubtilePx);
  }
};
inline void add_finishing(tb::UnitBench& bench, const Finishing& finishing, std::size_t groups,
                          FinishGroupIf& finished) {
  bench.add_thread("finishing", [&bench, &finished, finishing, groups](Activity&) {
    for (std::uint32_t g = 0; finishing.pitch > 0 && g < groups; ++g) {
      bench.clock().wait_cycles(finishing.pitch);
      finished.finish(g, 0);
    }
  });
}

inline void add_finishing_subtiles(tb::UnitBench& bench, const Finishing& finishing,
                                   const std::vector<PixelRect>& groups, FinishSubtileIf& mask) {
  bench.add_thread("finishing_subtiles", [&bench, &groups, &mask, finishing](Activity&) {
    for (std::uint32_t g = 0; finishing.pitch > 0 && g < groups.size(); ++g) {
      const std::size_t subtiles = Finishing::subtiles_along(groups[g].width()) *
                                   Finishing::subtiles_along(groups[g].height());
      for (std::size_t at = 0; at < subtiles; ++at) {
        bench.clock().wait_cycles(finishing.told(g, at, subtiles) - bench.clock().now_cycles());
        mask.finish(g, at, 0);
      }
    }
  });
}

// A bench without stalls whose units have such ports, before a memory of so many bytes.
inline tb::BenchConfig bench_of(const PortHardware& port, std::size_t memory_bytes) {
  tb::BenchConfig config;
  config.latency_cycles = port.read_latency;
  config.write_latency_cycles = port.write_latency;
  config.memory_bytes = memory_bytes;
  config.port = port.config;
  return config;
}

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
// When a sink has all: it has taken this, or so many.
inline auto until_taken(std::uint64_t what) {
  return [what](const Takings& taken) { return !taken.empty() && taken.back().what == what; };
}
inline auto until_items(std::size_t items) {
  return [items](const Takings& taken) { return taken.size() == items; };
}
// what_of: of an entry, to tell them apart.
template <class T, class Until, class WhatOf>
void add_sink(tb::UnitBench& bench, const std::string& name, const Until& until, const Pace& pace,
              TimedFifo<T>& from, Takings& taken, const WhatOf& what_of) {
  bench.add_thread(name, [&bench, &from, &taken, until, pace, what_of](Activity& activity) {
    while (!until(taken)) {
      bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of(from.pop(activity));
      taken.push_back({bench.clock().now_cycles(), what});
    }
  });
}

}  // namespace sgs::test
