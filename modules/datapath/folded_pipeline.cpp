// Schedule, then lives, then wiring: registers by lifetimes, then parts by what their inputs
// already select from.
#include "modules/datapath/folded_pipeline.h"

#include <algorithm>

namespace sgs {
namespace {

struct Life {
  std::uint32_t from = 0, cycles = 0;  // 0: no value, or none that waits
};

bool leaves_lane(StepBy by) { return part_kind(by) == StepBy::kLane || by == StepBy::kSum; }

std::vector<Life> lives(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
                        const OperationLatencies& latencies) {
  std::vector<Life> out(steps.size());
  std::vector<std::uint32_t> last(steps.size());
  std::vector<bool> taken(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].by == StepBy::kSum) continue;  // it takes its product inside the lane
    for (const LaneStep::Source& source : steps[i].sources) {
      if (source.value.is_constant) continue;
      last[source.value.of] = std::max(last[source.value.of], schedule.begins[i]);
      taken[source.value.of] = true;
    }
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].answers || (!taken[i] && !steps[i].kept)) continue;
    const std::uint32_t in_lane = leaves_lane(steps[i].by) ? 1 : 0;
    const std::uint32_t from = schedule.begins[i] + cycles_of(steps[i].by, latencies) + in_lane;
    const std::uint32_t until = steps[i].kept ? schedule.cycles : last[i];
    out[i] = {from, until + 1 - from};
  }
  return out;
}

// The inputs that a multiplexer selects from.
class Selection {
 public:
  bool has(std::uint64_t input) const {
    return std::find(inputs_.begin(), inputs_.end(), input) != inputs_.end();
  }
  // The first is a wire.
  std::uint32_t cost_of(std::uint64_t input) const { return inputs_.empty() || has(input) ? 0 : 1; }
  void take(std::uint64_t input) {
    if (!has(input)) inputs_.push_back(input);
    ++taken_;
  }
  std::uint32_t of_two() const {
    return inputs_.empty() ? 0 : static_cast<std::uint32_t>(inputs_.size() - 1);
  }
  // A word passes as many on its way as the tree of them has levels.
  std::uint32_t passed() const {
    std::uint32_t levels = 0;
    while ((std::size_t{1} << levels) < inputs_.size()) ++levels;
    return taken_ * levels;
  }

 private:
  std::vector<std::uint64_t> inputs_;
  std::uint32_t taken_ = 0;  // words, of an item
};

constexpr std::uint64_t kConstant = std::uint64_t{1} << 32, kPart = std::uint64_t{2} << 32,
                        kOutsideOf = std::uint64_t{3} << 32, kProductOf = std::uint64_t{4} << 32;
constexpr std::uint32_t kPorts = 3;

class Wiring {
 public:
  Wiring(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
         const FoldedParts& parts, const OperationLatencies& latencies)
      : steps_(steps),
        schedule_(schedule),
        parts_(parts),
        interval_(parts.interval_cycles),
        lives_(lives(steps, schedule, latencies)),
        chains_(steps.size()),
        part_of_(steps.size()) {}

  LaneWiring run() {
    take_registers();
    give_parts();
    return out_;
  }

 private:
  // Registers of its own for whole intervals; the rest of its life, an arc of the interval, in the
  // first register that is free for as long.
  void take_registers() {
    std::vector<std::uint32_t> arcs;
    for (std::uint32_t i = 0; i < steps_.size(); ++i) {
      for (std::uint32_t n = 0; n < lives_[i].cycles / interval_; ++n) {
        chains_[i].push_back(new_register());
      }
      if (lives_[i].cycles % interval_ > 0) arcs.push_back(i);
    }
    const auto begin = [&](std::uint32_t i) { return lives_[i].from % interval_; };
    std::stable_sort(arcs.begin(), arcs.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return begin(a) < begin(b); });
    const std::size_t first_shared = registers_.size();
    std::vector<std::vector<bool>> busy;
    for (const std::uint32_t i : arcs) {
      const std::uint32_t cycles = lives_[i].cycles % interval_;
      const auto is_free = [&](const std::vector<bool>& slots) {
        for (std::uint32_t c = 0; c < cycles; ++c) {
          if (slots[(begin(i) + c) % interval_]) return false;
        }
        return true;
      };
      const auto at =
          static_cast<std::size_t>(std::find_if(busy.begin(), busy.end(), is_free) - busy.begin());
      if (at == busy.size()) {
        busy.emplace_back(interval_);
        new_register();
      }
      for (std::uint32_t c = 0; c < cycles; ++c) busy[at][(begin(i) + c) % interval_] = true;
      chains_[i].push_back(static_cast<std::uint32_t>(first_shared + at));
    }
    out_.register_words = static_cast<std::uint32_t>(registers_.size());
    for (const auto& chain : chains_) {
      out_.words_written += static_cast<std::uint32_t>(chain.size());
    }
  }

  std::uint32_t new_register() {
    registers_.emplace_back();
    return static_cast<std::uint32_t>(registers_.size() - 1);
  }

  std::uint64_t input_of(const LaneStep::Source& source, std::uint32_t cycle) const {
    if (source.value.is_constant) return kConstant | source.value.of;
    const std::uint32_t value = source.value.of;
    if (cycle < lives_[value].from) return output_of(value);
    return chains_[value][(cycle - lives_[value].from) / interval_];
  }

  // Of a step that has its part.
  std::uint64_t output_of(std::uint32_t step) const {
    const StepBy by = steps_[step].by;
    if (by == StepBy::kOutside) return kOutsideOf | step;
    return (by == StepBy::kProduct ? kProductOf : kPart) | part_of_[step];
  }

  struct Part {
    Selection ports[kPorts];
    std::vector<bool> busy;
  };

  // Each step to the part whose multiplexers grow least by it.
  void give_parts() {
    std::vector<Part> of_kind[4];
    for (const StepBy by : {StepBy::kLane, StepBy::kComparator, StepBy::kTable}) {
      of_kind[static_cast<int>(by)].assign(parts_.of(by), {{}, std::vector<bool>(interval_)});
    }
    std::uint32_t first_of_kind = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::uint32_t i = 0; i < steps_.size(); ++i) {
        const StepBy by = steps_[i].by == StepBy::kSum ? StepBy::kLane : part_kind(steps_[i].by);
        if (static_cast<std::size_t>(by) != k) continue;
        give(i, of_kind[k], first_of_kind);
      }
      for (const Part& part : of_kind[k]) {
        for (const Selection& port : part.ports) count(port);
      }
      first_of_kind += static_cast<std::uint32_t>(of_kind[k].size());
    }
    for (const Selection& inputs : registers_) count(inputs);
  }
  void count(const Selection& inputs) {
    out_.select_words += inputs.of_two();
    out_.words_selected += inputs.passed();
  }

  void give(std::uint32_t step, std::vector<Part>& parts, std::uint32_t first_of_kind) {
    const StepBy by = steps_[step].by;
    if (by == StepBy::kSum) {
      part_of_[step] = part_of_[steps_[step].sources.front().value.of];
    } else if (by != StepBy::kOutside) {
      const std::uint64_t leaves = by == StepBy::kProduct ? kProductOf : kPart;
      std::size_t best = parts.size();
      bool best_swapped = false;
      std::uint32_t least = 0;
      for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].busy[schedule_.begins[step] % interval_]) continue;
        for (const bool swapped : {false, true}) {
          if (swapped && part_kind(by) != StepBy::kLane) continue;
          const std::uint32_t cost =
              cost_of(step, parts[p], swapped) + output_cost(step, leaves | (first_of_kind + p));
          if (best < parts.size() && cost >= least) continue;
          best = p;
          best_swapped = swapped;
          least = cost;
        }
      }
      Part& part = parts.at(best);
      part.busy[schedule_.begins[step] % interval_] = true;
      for (const LaneStep::Source& source : steps_[step].sources) {
        Selection& port = part.ports[port_of(source, best_swapped)];
        port.take(input_of(source, schedule_.begins[step]));
      }
      part_of_[step] = first_of_kind + static_cast<std::uint32_t>(best);
    }
    std::uint64_t output = output_of(step);
    for (const std::uint32_t to : chains_[step]) {
      registers_[to].take(output);
      output = to;
    }
  }

  static std::uint32_t port_of(const LaneStep::Source& source, bool swapped) {
    return swapped && source.port < 2 ? 1 - source.port : source.port;
  }
  std::uint32_t cost_of(std::uint32_t step, const Part& part, bool swapped) const {
    std::uint32_t cost = 0;
    for (const LaneStep::Source& source : steps_[step].sources) {
      cost +=
          part.ports[port_of(source, swapped)].cost_of(input_of(source, schedule_.begins[step]));
    }
    return cost;
  }
  std::uint32_t output_cost(std::uint32_t step, std::uint64_t output) const {
    return chains_[step].empty() ? 0 : registers_[chains_[step].front()].cost_of(output);
  }

  const std::vector<LaneStep>& steps_;
  const FoldedSchedule& schedule_;
  const FoldedParts& parts_;
  const std::uint32_t interval_;
  const std::vector<Life> lives_;
  std::vector<std::vector<std::uint32_t>> chains_;  // [step]: registers that its value passes
  std::vector<std::uint32_t> part_of_;              // [step]: the part that it is given
  std::vector<Selection> registers_;                // [register] sources that it is written from
  LaneWiring out_;
};

}  // namespace

LaneWiring lane_wiring(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
                       const FoldedParts& parts, const OperationLatencies& latencies) {
  return Wiring(steps, schedule, parts, latencies).run();
}

std::uint32_t most_alive(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
                         std::uint32_t interval_cycles, const OperationLatencies& latencies) {
  std::vector<std::uint32_t> alive(interval_cycles);
  for (const Life& life : lives(steps, schedule, latencies)) {
    for (std::uint32_t c = 0; c < life.cycles; ++c) ++alive[(life.from + c) % interval_cycles];
  }
  return *std::max_element(alive.begin(), alive.end());
}

FoldedPipeline folded_pipeline(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies) {
  FoldedPipeline out;
  out.parts = at_least(parts, steps);
  out.schedule = folded_schedule(steps, out.parts, latencies);
  shorten_lives(steps, out.parts, latencies, out.schedule);
  out.wiring = lane_wiring(steps, out.schedule, out.parts, latencies);
  return out;
}

}  // namespace sgs
