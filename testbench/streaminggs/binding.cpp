// Utilisations and what follows from them.
#include "testbench/streaminggs/binding.h"

#include <fmt/format.h>

#include <algorithm>

#include "modules/accelerator.h"

namespace sgs {
namespace {

double bus_share(Accelerator& accelerator) {
  const DramStats stats = accelerator.dram().stats();
  std::uint64_t busiest = 0;
  for (const DramChannelStats& channel : stats.channels) {
    busiest = std::max(busiest, channel.busy_cycles);
  }
  return stats.elapsed_cycles == 0
             ? 0
             : static_cast<double>(busiest) / static_cast<double>(stats.elapsed_cycles);
}

// The busiest of some activities.
ResourceUse busiest(const char* name, const std::vector<const Activity*>& activities,
                    std::uint64_t frame_cycles) {
  ResourceUse use{name};
  for (const Activity* activity : activities) {
    const double share =
        static_cast<double>(activity->busy_cycles()) / static_cast<double>(frame_cycles);
    if (use.activity == nullptr || share > use.utilisation) use = {name, share, activity};
  }
  return use;
}

std::string waiting(const ResourceUse& use) {
  if (use.activity == nullptr) return "waits for requests";
  return use.activity->starved_cycles() > use.activity->blocked_cycles()
             ? "waits for input"
             : "waits for room downstream";
}

}  // namespace

std::vector<ResourceUse> resource_uses(Accelerator& accelerator) {
  const std::uint64_t frame = std::max<std::uint64_t>(1, accelerator.frame_cycles());
  std::vector<const Activity*> vsu, coarse, decode, fine, sorting, merge;
  if (accelerator.vsu() != nullptr) vsu.push_back(&accelerator.vsu()->traverse_activity());
  if (accelerator.chunk_vsu() != nullptr) vsu.push_back(&accelerator.chunk_vsu()->walk_activity());
  if (accelerator.merge() != nullptr) merge.push_back(&accelerator.merge()->activity());
  for (const auto& hfu : accelerator.hfus()) {
    coarse.push_back(&hfu->coarse_activity());
    fine.push_back(&hfu->fine_activity());
    if (hfu->decode_activity() != nullptr) decode.push_back(hfu->decode_activity());
  }
  for (const auto& unit : accelerator.sorting_units()) sorting.push_back(&unit->activity());
  for (const auto& unit : accelerator.key_sorters()) sorting.push_back(&unit->activity());
  return {busiest("vsu", vsu, frame),
          busiest("coarse", coarse, frame),
          busiest("decode", decode, frame),
          busiest("fine", fine, frame),
          busiest("sorting", sorting, frame),
          busiest("merge", merge, frame),
          busiest("rendering", {&accelerator.rendering().blend_activity()}, frame),
          busiest("drain", {&accelerator.rendering().drain_activity()}, frame),
          {"dram", bus_share(accelerator), nullptr}};
}

Binding find_binding(Accelerator& accelerator) {
  std::vector<ResourceUse> uses = resource_uses(accelerator);
  std::stable_sort(uses.begin(), uses.end(), [](const ResourceUse& a, const ResourceUse& b) {
    return a.utilisation > b.utilisation;
  });
  Binding binding{uses[0].name, uses[1].name, uses[0].utilisation, uses[1].utilisation, ""};
  binding.explanation = fmt::format(
      "{} works {:.0f} % of the frame, {} {:.0f} %: {} with no limit of its own, the frame would "
      "take "
      "at least {:.0f} % of its time",
      binding.unit, 100 * binding.utilisation, binding.next, 100 * binding.next_utilisation,
      binding.unit, 100 * binding.next_utilisation);
  constexpr double kSaturated = 0.8;
  if (binding.utilisation < kSaturated) {
    binding.explanation += fmt::format(
        "; no resource is busy all the time: {} {} for the rest, so latency and order between the "
        "units hold the frame",
        binding.unit, waiting(uses[0]));
  }
  return binding;
}

}  // namespace sgs
