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

std::size_t kind(StepBy by) { return static_cast<std::size_t>(part_kind(by)); }

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
      ends[step] = place(step, ready, in_order);
    }
    return ends;
  }

 private:
  std::uint32_t latency(std::uint32_t step) const { return latency_of(steps_[step], latencies_); }

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
  std::uint32_t place(std::uint32_t step, std::uint32_t ready, bool in_order) {
    const StepBy by = steps_[step].by;
    const std::uint32_t latency = this->latency(step);
    if (part_kind(by) == StepBy::kOutside) return ready + latency;
    std::vector<std::uint32_t>& busy = busy_[kind(by)];
    for (std::uint32_t cycle = ready; cycle < ready + parts_.interval_cycles; ++cycle) {
      const std::uint32_t begin = in_order ? cycle : cycle + latency;
      std::uint32_t& taken = busy[begin % parts_.interval_cycles];
      if (taken == parts_.of(by)) continue;
      ++taken;
      return cycle + latency;
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

// A sum follows its product at once. Backward it may have got a later place.
void follow(const std::vector<LaneStep>& steps, const OperationLatencies& latencies,
            FoldedSchedule& schedule) {
  schedule.cycles = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const StepBy by = steps[i].by;
    if (by == StepBy::kOutside) continue;
    if (by == StepBy::kSum) {
      schedule.begins[i] = schedule.begins[steps[i].sources.front().value.of] + latencies.product();
    }
    schedule.cycles = std::max(schedule.cycles, schedule.begins[i] + cycles_of(by, latencies));
  }
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

std::vector<DatapathLoop> loops_of(const std::vector<LaneStep>& steps, const Edges& before,
                                   const FoldedSchedule& schedule,
                                   const OperationLatencies& latencies) {
  std::uint32_t lists = 0;
  for (const LaneStep& step : steps) lists = std::max(lists, step.comes_with);
  std::vector<DatapathLoop> loops(lists);
  for (std::uint32_t list = 1; list <= lists; ++list) {
    DatapathLoop& loop = loops[list - 1];
    std::vector<bool> depends(steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const bool comes = steps[i].comes_with == list;
      if (comes) loop.arrival = schedule.begins[i];
      depends[i] = comes || std::any_of(before[i].begin(), before[i].end(),
                                        [&](std::uint32_t from) { return depends[from]; });
      if (!depends[i]) continue;
      loop.end = std::max(loop.end, schedule.begins[i] + cycles_of(steps[i].by, latencies));
    }
  }
  return loops;
}

constexpr int kPasses = 6;
constexpr std::uint32_t kNone = ~0U;

class Mover {
 public:
  Mover(const std::vector<LaneStep>& steps, const FoldedParts& parts,
        const OperationLatencies& latencies, FoldedSchedule& schedule)
      : steps_(steps),
        parts_(parts),
        latencies_(latencies),
        schedule_(schedule),
        fixed_(steps.size()),
        sum_of_(steps.size(), kNone) {
    const Edges before = sources(steps);
    taken_by_ = reversed(before);
    for (auto& busy : busy_) busy.assign(parts.interval_cycles, 0);
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
      const StepBy by = steps[i].by;
      fixed_[i] = by == StepBy::kOutside;
      if (by == StepBy::kSum) sum_of_[steps[i].sources.front().value.of] = i;
      if (part_kind(by) != StepBy::kOutside) ++busy_of(by, schedule.begins[i]);
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
        if (!fixed_[step] && steps_[step].by != StepBy::kSum) move(step, pass % 2 == 0);
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

  // When it takes its sources: what comes from outside is read before it comes.
  std::uint32_t taken_from(std::uint32_t step) const {
    const bool is_outside = steps_[step].by == StepBy::kOutside;
    return schedule_.begins[step] - (is_outside ? latency_of(steps_[step], latencies_) : 0);
  }

  // The last cycle in which a step can begin so that its value is there in time.
  std::uint32_t last_begin(std::uint32_t step) const {
    const std::uint32_t latency = cycles_of(steps_[step].by, latencies_);
    std::uint32_t last = schedule_.cycles - latency;
    for (const std::uint32_t to : taken_by_[step]) {
      const std::uint32_t begin = to == sum_of_[step] ? last_begin(to) : taken_from(to);
      last = std::min(last, begin - latency);
    }
    return last;
  }

  // A product's sum moves with it.
  void move(std::uint32_t step, bool later) {
    const LaneStep& of = steps_[step];
    std::uint32_t& begin = schedule_.begins[step];
    const bool has_sum = sum_of_[step] != kNone;
    const std::uint32_t last = last_begin(step);
    std::uint32_t first = 0;
    std::array<std::uint32_t, 3> others_last{};  // [source] when other steps take it last
    std::size_t sources = 0;
    for (const LaneStep::Source& source : of.sources) {
      if (source.value.is_constant) continue;
      first = std::max(first, end(source.value.of));
      if (is_taken_before(of, source)) continue;
      others_last[sources++] = last_taken_but_by(step, source.value.of);
    }
    const std::uint32_t values = of.answers ? 0 : has_sum ? 2 : 1;
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
    if (has_sum) schedule_.begins[sum_of_[step]] = end(step);
    ++busy_of(of.by, begin);
  }

  // True if a source before this one has its value, as in a square: the value ends but once.
  static bool is_taken_before(const LaneStep& of, const LaneStep::Source& source) {
    for (const LaneStep::Source* before = of.sources.data(); before != &source; ++before) {
      if (!before->value.is_constant && before->value.of == source.value.of) return true;
    }
    return false;
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
  std::vector<std::uint32_t> sum_of_;  // [product]: the step that adds to it in its lane, or kNone
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
  follow(steps, latencies, out);
  arrive(steps, out);
  out.loops = loops_of(steps, before, out, latencies);
  return out;
}

void shorten_lives(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                   const OperationLatencies& latencies, FoldedSchedule& schedule) {
  Mover(steps, parts, latencies, schedule).run();
}

}  // namespace sgs
