// Greedy modulo scheduling of a graph without cycles; then moves of single steps, forth and back
// through the computation.
#include "modules/datapath/folded_schedule.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace sgs {
namespace {

constexpr std::size_t kKinds = 4;

std::size_t kind(StepBy by) { return static_cast<std::size_t>(by); }

std::array<std::uint32_t, kKinds> count(const std::vector<LaneStep>& steps) {
  std::array<std::uint32_t, kKinds> counts{};
  for (const LaneStep& step : steps) ++counts[kind(step.by)];
  return counts;
}

// [step]: those that it takes, or those that take it.
using Edges = std::vector<std::vector<std::uint32_t>>;

Edges sources(const std::vector<LaneStep>& steps) {
  Edges edges(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const LaneStep::Source& source : steps[i].sources) {
      if (!source.value.is_constant) edges[i].push_back(source.value.of);
    }
  }
  return edges;
}

Edges reversed(const Edges& edges) {
  Edges out(edges.size());
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    for (const std::uint32_t from : edges[i]) out[from].push_back(i);
  }
  return out;
}

class Scheduler {
 public:
  Scheduler(const std::vector<LaneStep>& steps, const FoldedParts& parts,
            const OperationLatencies& latencies)
      : steps_(steps), parts_(parts), latencies_(latencies) {}

  // Cycles from the beginning of each step to its end, or backward from the end of the computation:
  // before: what has to be done first, after: the other way round.
  std::vector<std::uint32_t> ends(const Edges& before, const Edges& after, bool in_order) {
    const std::vector<std::uint32_t> rest = paths(after, !in_order);
    std::vector<std::uint32_t> order(steps_.size());
    std::iota(order.begin(), order.end(), 0U);
    // Values from outside take no time: they stand before those of the same rest.
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (rest[a] != rest[b]) return rest[a] > rest[b];
      return in_order ? a < b : a > b;
    });
    for (auto& busy : busy_) busy.assign(parts_.interval_cycles, 0);
    std::vector<std::uint32_t> ends(steps_.size());
    for (const std::uint32_t step : order) {
      std::uint32_t ready = 0;
      for (const std::uint32_t from : before[step]) ready = std::max(ready, ends[from]);
      ends[step] = place(steps_[step].by, ready);
    }
    return ends;
  }

 private:
  std::uint32_t latency(std::uint32_t step) const { return cycles_of(steps_[step].by, latencies_); }

  // Longest from each step's beginning to the end, over these edges.
  std::vector<std::uint32_t> paths(const Edges& edges, bool in_order) const {
    const auto size = static_cast<std::uint32_t>(steps_.size());
    std::vector<std::uint32_t> out(size);
    for (std::uint32_t i = 0; i < size; ++i) {
      const std::uint32_t step = in_order ? i : size - 1 - i;
      for (const std::uint32_t to : edges[step]) out[step] = std::max(out[step], out[to]);
      out[step] += latency(step);
    }
    return out;
  }

  // Backward a step begins where, forward, it ends: a part is taken at the same distance from it.
  std::uint32_t place(StepBy by, std::uint32_t ready) {
    if (by == StepBy::kOutside) return ready;
    std::vector<std::uint32_t>& busy = busy_[kind(by)];
    const std::uint32_t end = ready + cycles_of(by, latencies_);
    for (std::uint32_t cycle = end; cycle < end + parts_.interval_cycles; ++cycle) {
      std::uint32_t& taken = busy[cycle % parts_.interval_cycles];
      if (taken == parts_.of(by)) continue;
      ++taken;
      return cycle;
    }
    throw std::logic_error("folded schedule: more steps than parts have turns in an interval");
  }

  const std::vector<LaneStep>& steps_;
  const FoldedParts& parts_;
  const OperationLatencies& latencies_;
  std::array<std::vector<std::uint32_t>, kKinds> busy_;
};

std::uint32_t most(const std::vector<std::uint32_t>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

// Sets the arrival of values from outside: 0, or for values that come together the cycle in which
// the first of them is taken.
void arrive(const std::vector<LaneStep>& steps, FoldedSchedule& schedule) {
  std::uint32_t lists = 0;
  for (const LaneStep& step : steps) lists = std::max(lists, step.comes_with);
  std::vector<std::uint32_t> arrival(lists + 1, schedule.cycles);
  const auto comes_with = [&](const LaneStep::Source& source) {
    return source.value.is_constant ? 0 : steps[source.value.of].comes_with;
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const LaneStep::Source& source : steps[i].sources) {
      std::uint32_t& first = arrival[comes_with(source)];
      first = std::min(first, schedule.begins[i]);
    }
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].by != StepBy::kOutside) continue;
    schedule.begins[i] = steps[i].comes_with == 0 ? 0 : arrival[steps[i].comes_with];
  }
}

std::uint32_t longest_loop(const std::vector<LaneStep>& steps, const Edges& before,
                           const FoldedSchedule& schedule, const OperationLatencies& latencies) {
  constexpr std::uint32_t kNever = ~0U;
  std::vector<std::uint32_t> since(steps.size(), kNever);  // earliest arrival that it depends on
  std::uint32_t longest = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].comes_with > 0) since[i] = schedule.begins[i];
    for (const std::uint32_t from : before[i]) since[i] = std::min(since[i], since[from]);
    if (since[i] == kNever) continue;
    longest = std::max(longest, schedule.begins[i] + cycles_of(steps[i].by, latencies) - since[i]);
  }
  return longest;
}

constexpr int kPasses = 6;

class Mover {
 public:
  Mover(const std::vector<LaneStep>& steps, const FoldedParts& parts,
        const OperationLatencies& latencies, FoldedSchedule& schedule)
      : steps_(steps),
        parts_(parts),
        latencies_(latencies),
        schedule_(schedule),
        fixed_(steps.size()) {
    const Edges before = sources(steps);
    taken_by_ = reversed(before);
    for (auto& busy : busy_) busy.assign(parts.interval_cycles, 0);
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
      fixed_[i] = steps[i].by == StepBy::kOutside;
      if (!fixed_[i]) ++busy_of(steps[i].by, schedule.begins[i]);
      for (const std::uint32_t from : before[i]) {
        const bool is_outside = steps[from].by == StepBy::kOutside;
        if (is_outside ? steps[from].comes_with > 0 : fixed_[from]) fixed_[i] = true;
      }
    }
  }

  void run() {
    const auto size = static_cast<std::uint32_t>(steps_.size());
    for (int pass = 0; pass < kPasses; ++pass) {
      // Later, from the end on; then earlier, from the beginning on.
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t step = pass % 2 == 0 ? size - 1 - i : i;
        if (!fixed_[step]) move(step, pass % 2 == 0);
      }
    }
    schedule_.cycles = 0;
    for (std::uint32_t i = 0; i < size; ++i) schedule_.cycles = std::max(schedule_.cycles, end(i));
  }

 private:
  std::uint32_t& busy_of(StepBy by, std::uint32_t cycle) {
    return busy_[kind(by)][cycle % parts_.interval_cycles];
  }
  std::uint32_t end(std::uint32_t step) const {
    return schedule_.begins[step] + cycles_of(steps_[step].by, latencies_);
  }

  void move(std::uint32_t step, bool later) {
    const LaneStep& of = steps_[step];
    std::uint32_t& begin = schedule_.begins[step];
    const std::uint32_t latency = cycles_of(of.by, latencies_);
    std::uint32_t first = 0, last = schedule_.cycles - latency;
    for (const std::uint32_t to : taken_by_[step]) {
      last = std::min(last, schedule_.begins[to] - latency);
    }
    std::array<std::uint32_t, 3> others_last{};  // [source] when other steps take it last
    std::size_t sources = 0;
    for (const LaneStep::Source& source : of.sources) {
      if (source.value.is_constant) continue;
      first = std::max(first, end(source.value.of));
      others_last[sources++] = last_taken_but_by(step, source.value.of);
    }
    // A square or a reciprocal's step takes a value twice, which ends but once.
    if (sources > 1 && takes_twice(of)) --sources;
    const std::uint32_t values = of.answers ? 0 : 1;
    const auto lives = [&](std::uint32_t cycle) {
      std::uint32_t sum = values * (schedule_.cycles - cycle);
      for (std::size_t s = 0; s < sources; ++s) sum += std::max(others_last[s], cycle);
      return sum;
    };
    --busy_of(of.by, begin);
    std::uint32_t best = begin;
    for (std::uint32_t n = 0; n <= last - first; ++n) {
      const std::uint32_t cycle = later ? last - n : first + n;
      if (busy_of(of.by, cycle) == parts_.of(of.by)) continue;
      const std::uint32_t now = lives(cycle), least = lives(best);
      if (now < least || (now == least && (later ? cycle > best : cycle < best))) best = cycle;
    }
    begin = best;
    ++busy_of(of.by, begin);
  }

  // True if a step takes a value twice: at its first port and again at its last.
  static bool takes_twice(const LaneStep& of) {
    const DataFlow::Operand &a = of.sources.front().value, &b = of.sources.back().value;
    return of.sources.size() > 1 && !a.is_constant && !b.is_constant && a.of == b.of;
  }

  std::uint32_t last_taken_but_by(std::uint32_t step, std::uint32_t value) const {
    if (steps_[value].kept) return schedule_.cycles;
    std::uint32_t last = 0;
    for (const std::uint32_t to : taken_by_[value]) {
      if (to != step) last = std::max(last, schedule_.begins[to]);
    }
    return last;
  }

  const std::vector<LaneStep>& steps_;
  const FoldedParts& parts_;
  const OperationLatencies& latencies_;
  FoldedSchedule& schedule_;
  Edges taken_by_;
  std::vector<bool> fixed_;
  std::array<std::vector<std::uint32_t>, kKinds> busy_;  // [kind][cycle of the interval]
};

}  // namespace

FoldedParts at_least(FoldedParts parts, const std::vector<LaneStep>& steps) {
  const auto counts = count(steps);
  const auto enough = [&](std::uint32_t stand, StepBy by) {
    const std::uint32_t each = parts.interval_cycles;
    return std::max(stand, (counts[kind(by)] + each - 1) / each);
  };
  parts.lanes = enough(parts.lanes, StepBy::kLane);
  parts.comparators = enough(parts.comparators, StepBy::kComparator);
  parts.tables = enough(parts.tables, StepBy::kTable);
  return parts;
}

FoldedSchedule folded_schedule(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies) {
  const Edges before = sources(steps), after = reversed(before);
  Scheduler scheduler(steps, parts, latencies);
  const std::vector<std::uint32_t> forward = scheduler.ends(before, after, true);
  const std::vector<std::uint32_t> backward = scheduler.ends(after, before, false);
  FoldedSchedule out;
  out.cycles = std::min(most(forward), most(backward));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    out.begins.push_back(most(forward) <= most(backward)
                             ? forward[i] - cycles_of(steps[i].by, latencies)
                             : out.cycles - backward[i]);
  }
  arrive(steps, out);
  out.loop_cycles = longest_loop(steps, before, out, latencies);
  return out;
}

void shorten_lives(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                   const OperationLatencies& latencies, FoldedSchedule& schedule) {
  Mover(steps, parts, latencies, schedule).run();
}

}  // namespace sgs
