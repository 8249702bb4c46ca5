// Utilisations, the way of waiting, and what follows from them.
#include "testbench/streaminggs/report/binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace sgs {
namespace {

using Activities = std::map<std::string, const ActivityResult*>;  // by path

double share(std::uint64_t cycles, const FrameResult& frame) {
  return static_cast<double>(cycles) / std::max(1.0, static_cast<double>(frame.cycles));
}

Activities activities_of(const FrameResult& frame) {
  Activities all;
  for (const UnitResult& unit : frame.machine.units) {
    for (const ActivityResult& a : unit.activities) all[unit.name + "." + a.name] = &a;
  }
  return all;
}

// Having nothing to do is no cause; nor is a phase ahead of its own, which is work of others.
bool is_cause(WaitFor what) { return what != WaitFor::kIdle && what != WaitFor::kPhase; }

// The place of the most cycles among those of the cause of the most; null: it never waited.
const WaitResult* longest_wait(const ActivityResult& activity) {
  WaitFor most = WaitFor::kIdle;
  std::uint64_t cycles = 0;
  for (const WaitResult& wait : activity.waits) {
    if (!is_cause(wait.what) || activity.waited_for(wait.what) <= cycles) continue;
    most = wait.what;
    cycles = activity.waited_for(wait.what);
  }
  const WaitResult* longest = nullptr;
  for (const WaitResult& wait : activity.waits) {
    if (most == WaitFor::kIdle || wait.what != most) continue;
    if (longest == nullptr || wait.cycles > longest->cycles) longest = &wait;
  }
  return longest;
}

const char* meaning(WaitFor what) {
  constexpr std::array<const char*, kWaitForCount> kMeanings = {"nothing to do",
                                                                "input",
                                                                "answers to its reads",
                                                                "answers to its writes",
                                                                "room behind it",
                                                                "room in its memory port",
                                                                "on-chip memory being filled",
                                                                "its phase of the frame"};
  return kMeanings[static_cast<std::size_t>(what)];
}

// The display of a stream keeps poses and frame buffers back.
bool is_display(const std::string& place) {
  const std::string port = ".host";
  return place.size() > port.size() &&
         place.compare(place.size() - port.size(), port.size(), port) == 0;
}

// The longest wait of an activity for a buffer that the display shows; none without a display,
// where the frame before is yet to be drawn.
struct DisplayWait {
  std::string activity;
  std::string at;
  std::uint64_t cycles = 0;
};

DisplayWait longest_display_wait(const FrameResult& frame) {
  DisplayWait longest;
  if (frame.stream.pictures == 0) return longest;
  for (const UnitResult& unit : frame.machine.units) {
    for (const ActivityResult& activity : unit.activities) {
      for (const WaitResult& wait : activity.waits) {
        if (wait.what != WaitFor::kRoom || !is_display(wait.at)) continue;
        if (wait.cycles <= longest.cycles) continue;
        longest = {unit.name + "." + activity.name, wait.at, wait.cycles};
      }
    }
  }
  return longest;
}

std::string waits_text(const ActivityResult& activity, const WaitResult& wait,
                       const FrameResult& frame) {
  return fmt::format("waits for {} {:.0f} % of the frame", meaning(wait.what),
                     100 * share(activity.waited_for(wait.what), frame));
}

std::string text_of(const Remedy& remedy) {
  return (remedy.turn == Turn::kUp ? "raise " : "lower ") + remedy.key;
}

// "the waiting of a leads to b, which waits for input 40 % of the frame, at fifo"
std::string text_of(const Cause& cause) {
  const std::string& first = cause.path.front();
  const std::string& last = cause.path.back();
  const std::string at = cause.holds == last ? "" : ", at " + cause.holds;
  if (first == last) return fmt::format("{} {}{}", first, cause.why, at);
  return fmt::format("the waiting of {} leads to {}, which {}{}", first, last, cause.why, at);
}

// Twice as much of it can save half the share in which it works; no more waiting, the rest.
constexpr double kMostly = 2.0 / 3;

// Share of the frame in which the activity is busy, without the time that others take before and
// after it.
double share_of_phase(const ActivityResult& activity, const FrameResult& frame) {
  const auto own = static_cast<double>(frame.cycles - activity.waited_for(WaitFor::kPhase));
  return static_cast<double>(activity.busy_cycles) / std::max(1.0, own);
}

std::string works_text(const ActivityResult& activity, const FrameResult& frame) {
  std::string text =
      fmt::format("works {:.0f} % of the frame", 100 * share(activity.busy_cycles, frame));
  if (activity.waited_for(WaitFor::kPhase) == 0) return text;
  return text + fmt::format(", {:.0f} % of its phase", 100 * share_of_phase(activity, frame));
}

// The busiest activity among those whose phase takes half of the frame or more, if there is one: it
// has the most to give.
Activities::const_iterator busiest_of(const Activities& activities, const FrameResult& frame) {
  const auto rank = [&](const ActivityResult& activity) {
    const bool longest = 2 * activity.waited_for(WaitFor::kPhase) <= frame.cycles;
    return std::pair(longest && activity.busy_cycles > 0, activity.busy_cycles);
  };
  return std::max_element(activities.begin(), activities.end(), [&](const auto& a, const auto& b) {
    return rank(*a.second) < rank(*b.second);
  });
}

// Share of the frame from which on a wait for the display is told beside the verdict.
constexpr double kTold = 0.01;

constexpr const char* kNoKey = "no key of the configuration is known to change that";

}  // namespace

std::vector<ResourceUse> resource_uses(const FrameResult& frame) {
  std::vector<ResourceUse> uses;
  for (const UnitResult& unit : frame.machine.units) {
    for (const ActivityResult& activity : unit.activities) {
      const ResourceUse use{activity.resource, share(activity.busy_cycles, frame), activity.remedy};
      const auto same = std::find_if(uses.begin(), uses.end(), [&](const ResourceUse& other) {
        return other.name == use.name;
      });
      if (same == uses.end()) {
        uses.push_back(use);
      } else if (use.utilisation > same->utilisation) {
        *same = use;
      }
    }
  }
  uses.push_back({"dram", frame.memory.bus_utilisation, frame.memory.remedy});
  return uses;
}

Cause follow_waiting(const FrameResult& frame) {
  const Activities activities = activities_of(frame);
  const auto busiest = busiest_of(activities, frame);
  Cause cause;
  if (busiest == activities.end()) return cause;
  std::uint64_t to_explain = 0;  // cycles that the one before waited
  for (auto at = busiest;;) {
    const ActivityResult& activity = *at->second;
    cause.path.push_back(at->first);
    cause.holds = at->first;
    cause.remedy = activity.remedy;
    const WaitResult* wait = longest_wait(activity);
    const std::uint64_t waited = wait == nullptr ? 0 : activity.waited_for(wait->what);
    const bool fills_its_phase =
        activity.waited_for(WaitFor::kPhase) > 0 && share_of_phase(activity, frame) >= kMostly;
    if (wait == nullptr || 2 * waited < to_explain || fills_its_phase) {
      cause.why = works_text(activity, frame);
      return cause;
    }
    const auto other = activities.find(wait->other);
    const bool met =
        std::find(cause.path.begin(), cause.path.end(), wait->other) != cause.path.end();
    if (other == activities.end() || met) {
      cause.holds = wait->at;
      cause.remedy = wait->remedy;
      cause.why = waits_text(activity, *wait, frame);
      return cause;
    }
    to_explain = waited;
    at = other;
  }
}

Binding find_binding(const FrameResult& frame) {
  std::vector<ResourceUse> uses = resource_uses(frame);
  std::stable_sort(uses.begin(), uses.end(), [](const ResourceUse& a, const ResourceUse& b) {
    return a.utilisation > b.utilisation;
  });
  const ResourceUse& busiest = uses[0];
  const ResourceUse next = uses.size() > 1 ? uses[1] : ResourceUse{"nothing else", 0, {}};
  Binding binding{
      busiest.name, next.name, busiest.utilisation, next.utilisation, busiest.name, busiest.remedy,
      "",           ""};
  binding.explanation = fmt::format(
      "{} works {:.0f} % of the frame, {} {:.0f} %: {} with no limit of its own, the frame would "
      "take at least {:.0f} % of its time",
      binding.unit, 100 * binding.utilisation, binding.next, 100 * binding.next_utilisation,
      binding.unit, 100 * binding.next_utilisation);
  Cause cause = follow_waiting(frame);
  const DisplayWait display = longest_display_wait(frame);
  const double held = share(display.cycles, frame);
  const std::string held_text =
      fmt::format("waits for a buffer that the display shows {:.0f} % of the frame", 100 * held);
  if (display.cycles > 0 && held >= (1 - binding.utilisation) / 2) {
    cause = {{display.activity}, display.at, held_text, {}};
  }
  const bool waits = binding.utilisation < kMostly && !cause.path.empty();
  if (held >= kTold && !(waits && cause.holds == display.at)) {
    binding.explanation += fmt::format("; {} {}", display.activity, held_text);
  }
  if (waits) {
    binding.holds = cause.holds;
    binding.remedy = cause.remedy;
    binding.explanation += "; no resource works more than two thirds of it: " + text_of(cause);
  }
  if (is_display(binding.holds)) {
    binding.advice =
        "there the display holds it back: --frame-rate 0 tells what limits the frames themselves";
  } else if (binding.remedy.known()) {
    binding.advice = text_of(binding.remedy);
  } else if (busiest.remedy.known()) {
    binding.remedy = busiest.remedy;
    binding.advice = fmt::format("{}; to shorten what {} works, {}", kNoKey, busiest.name,
                                 text_of(binding.remedy));
  } else {
    binding.advice = kNoKey;
  }
  return binding;
}

Binding find_binding(const FrameResult& frame, const Totals& area) {
  Binding binding = find_binding(frame);
  if (binding.remedy.known() && binding.remedy.key == frame.memory.remedy.key) {
    binding.advice += fmt::format(": twice as many add {} mm2 of PHY and controller",
                                  in_words(area.memory_interface));
  }
  return binding;
}

Binding without_advice(Binding binding) {
  binding.remedy = {};
  binding.advice = "no Gaussian contributes to the picture: there is nothing to change";
  return binding;
}

}  // namespace sgs
