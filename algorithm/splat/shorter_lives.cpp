// Moves of single steps, forth and back through the computation.
#include "algorithm/splat/shorter_lives.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace sgs {
namespace {

constexpr int kPasses = 6;

class Mover {
 public:
  Mover(const std::vector<LaneStep>& steps, const FoldedParts& parts,
        const OperationLatencies& latencies, FoldedSchedule& schedule)
      : steps_(steps),
        parts_(parts),
        latencies_(latencies),
        schedule_(schedule),
        taken_by_(steps.size()),
        fixed_(steps.size()) {
    for (auto& busy : busy_) busy.assign(parts.interval_cycles, 0);
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
      fixed_[i] = steps[i].by == StepBy::kOutside;
      if (!fixed_[i]) ++busy_of(steps[i].by, schedule.begins[i]);
      for (const LaneStep::Source& source : steps[i].sources) {
        if (source.value.is_constant) continue;
        taken_by_[source.value.of].push_back(i);
        const LaneStep& from = steps[source.value.of];
        if (from.by == StepBy::kOutside ? from.comes_with > 0 : fixed_[source.value.of]) {
          fixed_[i] = true;
        }
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
    return busy_[static_cast<std::size_t>(by)][cycle % parts_.interval_cycles];
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
    std::array<std::uint32_t, 3> others_last{};  // of each source: when others take it last
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

  // At its first port and again at its last.
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
  std::vector<std::vector<std::uint32_t>> taken_by_;
  std::vector<bool> fixed_;
  std::array<std::vector<std::uint32_t>, 4> busy_;  // [kind][cycle of the interval]
};

}  // namespace

void shorten_lives(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                   const OperationLatencies& latencies, FoldedSchedule& schedule) {
  Mover(steps, parts, latencies, schedule).run();
}

}  // namespace sgs
