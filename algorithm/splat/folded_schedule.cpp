// Greedy modulo scheduling of a graph without cycles.
#include "algorithm/splat/folded_schedule.h"

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

// What is read when it is needed comes when the first of it is taken.
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

}  // namespace sgs
