// Utilisations and what follows from them.
#include "testbench/streaminggs/binding.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgs {

std::vector<ResourceUse> resource_uses(const FrameResult& frame) {
  const double cycles = std::max(1.0, static_cast<double>(frame.cycles));
  std::vector<ResourceUse> uses;
  for (const UnitResult& unit : frame.machine.units) {
    for (const ActivityResult& activity : unit.activities) {
      const ResourceUse use{activity.resource, static_cast<double>(activity.busy_cycles) / cycles,
                            activity.starved_cycles > activity.blocked_cycles
                                ? "waits for input"
                                : "waits for room downstream"};
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
  uses.push_back({"dram", frame.memory.bus_utilisation, "waits for requests"});
  return uses;
}

Binding find_binding(const FrameResult& frame) {
  std::vector<ResourceUse> uses = resource_uses(frame);
  std::stable_sort(uses.begin(), uses.end(), [](const ResourceUse& a, const ResourceUse& b) {
    return a.utilisation > b.utilisation;
  });
  const ResourceUse next = uses.size() > 1 ? uses[1] : ResourceUse{"nothing else", 0, ""};
  Binding binding{uses[0].name, next.name, uses[0].utilisation, next.utilisation, ""};
  binding.explanation = fmt::format(
      "{} works {:.0f} % of the frame, {} {:.0f} %: {} with no limit of its own, the frame would "
      "take at least {:.0f} % of its time",
      binding.unit, 100 * binding.utilisation, binding.next, 100 * binding.next_utilisation,
      binding.unit, 100 * binding.next_utilisation);
  constexpr double kSaturated = 0.8;
  if (binding.utilisation < kSaturated) {
    binding.explanation += fmt::format(
        "; no resource is busy all the time: {} {} for the rest, so latency and order between the "
        "units hold the frame",
        binding.unit, uses[0].waits);
  }
  return binding;
}

}  // namespace sgs
