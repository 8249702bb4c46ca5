// Gains, their order, and what they say of the binding.
#include "testbench/streaminggs/what_if/what_if.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithm/files/input_error.h"
#include "testbench/streaminggs/report/frame_noise.h"

namespace sgs {
namespace {

double saved(double before, double after) { return before > 0 ? 1 - after / before : 0; }

// The doubling of the binding's remedy, which may have been refused; null: nothing doubles it.
const Doubling* named_by(const Binding& binding, const std::vector<Doubling>& doublings) {
  const auto named = std::find_if(doublings.begin(), doublings.end(), [&](const Doubling& each) {
    return each.key == binding.remedy.key;
  });
  return named == doublings.end() ? nullptr : &*named;
}

// Half of a value; whole cycles are rounded up.
double halved(double value) {
  return std::floor(value) == value ? std::ceil(value / 2) : value / 2;
}

}  // namespace

Doubling::Doubling(const Remedy& remedy, double value)
    : key(remedy.key), from(value), to(remedy.turn == Turn::kUp ? 2 * value : halved(value)) {}

std::vector<Remedy> remedies_of(const FrameResult& frame) {
  std::vector<Remedy> all;
  const auto add = [&](const Remedy& remedy) {
    const auto same = [&](const Remedy& other) { return other.key == remedy.key; };
    if (remedy.known() && std::none_of(all.begin(), all.end(), same)) all.push_back(remedy);
  };
  for (const UnitResult& unit : frame.machine.units) {
    for (const ActivityResult& activity : unit.activities) {
      add(activity.remedy);
      for (const WaitResult& wait : activity.waits) add(wait.remedy);
    }
    for (const Remedy& remedy : unit.may_help) add(remedy);
  }
  add(frame.memory.remedy);
  return all;
}

double time_saved(const Outcome& base, const Outcome& doubled) {
  return saved(static_cast<double>(base.cycles), static_cast<double>(doubled.cycles));
}

double energy_saved(const Outcome& base, const Outcome& doubled) {
  return saved(base.joules, doubled.joules);
}

std::string change_in_words(double saved) {
  const double tenths = std::round(-1000 * saved);
  return tenths == 0 ? "0.0 %" : fmt::format("{:+.1f} %", tenths / 10);
}

bool time_is_noise(const Outcome& base, const Outcome& doubled) {
  return below_noise(time_saved(base, doubled));
}

bool energy_is_noise(const Outcome& base, const Outcome& doubled) {
  return base.cycles != doubled.cycles && below_noise(energy_saved(base, doubled));
}

std::string saved_per_mm2(const Outcome& base, const Outcome& doubled, double saved) {
  const double added = doubled.mm2_with_memory_interface - base.mm2_with_memory_interface;
  if (added < kLeastAddedArea * base.mm2_with_memory_interface) return "-";
  return change_in_words(saved / added);
}

std::string noise_in_words(const Outcome& base, const Outcome& doubled) {
  std::vector<std::string> noise;
  if (time_is_noise(base, doubled)) noise.emplace_back("time");
  if (energy_is_noise(base, doubled)) noise.emplace_back("energy");
  return noise.empty() ? "" : fmt::format("; {} {}", join(noise, " and "), kBelowNoise);
}

void rank(const Outcome& base, std::vector<Doubling>& doublings) {
  std::stable_sort(doublings.begin(), doublings.end(), [&](const Doubling& a, const Doubling& b) {
    if (a.refused.empty() != b.refused.empty()) return a.refused.empty();
    if (!a.refused.empty()) return false;
    const double gain_a = time_saved(base, a.outcome), gain_b = time_saved(base, b.outcome);
    if (gain_a != gain_b) return gain_a > gain_b;
    return a.outcome.mm2_with_memory_interface < b.outcome.mm2_with_memory_interface;
  });
}

bool named_gains_most(const Outcome& base, const std::vector<Doubling>& doublings) {
  const Doubling* named = named_by(base.binding, doublings);
  return named != nullptr && named->refused.empty() &&
         time_saved(base, doublings.front().outcome) - time_saved(base, named->outcome) <
             kFrameNoise;
}

std::string verdict(const Outcome& base, const std::vector<Doubling>& doublings) {
  const Binding& binding = base.binding;
  if (doublings.empty() || !doublings.front().refused.empty()) {
    return "nothing could be doubled";
  }
  const Doubling& best = doublings.front();
  const double most = time_saved(base, best.outcome);
  if (most < kFrameNoise) {
    return fmt::format("nothing doubled gains more than the noise of a frame, {} % of the time",
                       100 * kFrameNoise);
  }
  const Doubling* named = named_by(binding, doublings);
  if (named == nullptr) {
    return fmt::format(
        "binding names {}, which no key doubles; {} gains most: {:.1f} % of the time",
        binding.holds, best.key, 100 * most);
  }
  if (!named->refused.empty()) {
    return fmt::format("binding names {}, but {} is refused; {} gains most: {:.1f} % of the time",
                       named->key, named->to, best.key, 100 * most);
  }
  const double gain = time_saved(base, named->outcome);
  if (named_gains_most(base, doublings)) {
    return fmt::format("binding names {}, and it gains most: {:.1f} % of the time", named->key,
                       100 * gain);
  }
  const Binding& then = named->outcome.binding;
  return fmt::format(
      "binding names {}, which gains {:.1f} % of the time; {} gains most: {:.1f} %. With {}={}, "
      "{} holds the frame: {} works {:.0f} % of it",
      named->key, 100 * gain, best.key, 100 * most, named->key, named->to, then.holds, then.unit,
      100 * then.utilisation);
}

}  // namespace sgs
