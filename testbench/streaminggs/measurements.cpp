// Counters of the units and of the memory as JSON.
#include "testbench/streaminggs/measurements.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "modules/accelerator.h"
#include "testbench/streaminggs/binding.h"
#include "testbench/streaminggs/energy.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// "accelerator.hfu0.coarse" -> "hfu0.coarse"
std::string short_name(const Activity& activity) {
  const std::string& name = activity.name();
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? name : name.substr(dot + 1);
}

Json unit_times(const Activity& activity) {
  return {{"busy_cycles", activity.busy_cycles()},
          {"starved_cycles", activity.starved_cycles()},
          {"blocked_cycles", activity.blocked_cycles()}};
}

Json work_of(const VsuCounters& c) {
  return {{"rays", c.rays},
          {"steps", c.steps},
          {"edges", c.edges},
          {"visits", c.visits},
          {"visits_saturated", c.visits_saturated},
          {"groups_empty", c.groups_empty},
          {"ordering_table_bytes_max", c.table_bytes_max},
          {"node_cache_misses", c.node_misses},
          {"record_cache_misses", c.record_misses}};
}

Json work_of(const ChunkVsuCounters& c) {
  return {{"nodes", c.nodes},
          {"node_cache_misses", c.node_misses},
          {"tests", c.tests},
          {"visits", c.visits},
          {"groups_saturated", c.groups_saturated},
          {"groups_empty", c.groups_empty},
          {"queue_entries_max", c.queue_max},
          {"queue_entries_put_aside", c.overflowed}};
}

Json work_of(const KeySorterCounters& c) {
  return {{"visits", c.visits},
          {"visits_trivial", c.visits_trivial},
          {"keys", c.keys},
          {"compare_exchanges", c.compare_exchanges}};
}

Json work_of(const MergeCounters& c) {
  return {{"keys", c.keys},
          {"released", c.released},
          {"forced_early", c.forced_early},
          {"dropped_saturated", c.dropped_saturated},
          {"pending_keys_max", c.pending_max},
          {"ties_looked_up", c.ties},
          {"runs_spilled", c.runs_spilled},
          {"keys_spilled", c.keys_spilled}};
}

Json work_of(const HfuCounters& c) {
  return {{"first_halves", c.first_halves},
          {"coarse_tests", c.coarse_tests},
          {"coarse_passed", c.coarse_passed},
          {"second_halves", c.second_halves},
          {"fine_tests", c.fine_tests},
          {"splats", c.splats},
          {"dropped_saturated", c.dropped_saturated}};
}

Json work_of(const SortingCounters& c) {
  return {{"visits", c.visits},
          {"visits_trivial", c.visits_trivial},
          {"splats", c.splats},
          {"splats_saturated", c.splats_saturated},
          {"compare_exchanges", c.compare_exchanges},
          {"runs_spilled", c.runs_spilled},
          {"entries_spilled", c.entries_spilled},
          {"list_max", c.list_max}};
}

Json work_of(const RenderingCounters& c) {
  return {{"groups", c.groups},
          {"groups_saturated", c.groups_saturated},
          {"splats", c.splats},
          {"splats_saturated", c.splats_saturated},
          {"subtile_tests", c.subtile_tests},
          {"subtile_blends", c.subtile_blends},
          {"contributors", c.contributors}};
}

Json work_of(const CodebookCounters& c) {
  return {{"bytes_loaded", c.bytes_loaded},
          {"loaded_at_cycle", c.loaded_at_cycle},
          {"records_decoded", c.records},
          {"lines_read", c.lines},
          {"bank_conflict_cycles", c.conflict_cycles}};
}

Json units_of(Accelerator& accelerator) {
  Json units;
  for (const Activity* activity : accelerator.activities()) {
    units[short_name(*activity)] = unit_times(*activity);
  }
  // The work of a unit of several activities stands with the one that does it.
  const auto add = [&](const std::string& activity, const Json& work) {
    units[activity].update(work);
  };
  if (accelerator.vsu() != nullptr) add("vsu.traverse", work_of(accelerator.vsu()->counters()));
  if (accelerator.chunk_vsu() != nullptr) {
    add("vsu.walk", work_of(accelerator.chunk_vsu()->counters()));
  }
  for (std::size_t h = 0; h < accelerator.hfus().size(); ++h) {
    add(fmt::format("hfu{}.coarse", h), work_of(accelerator.hfus()[h]->counters()));
  }
  for (std::size_t s = 0; s < accelerator.sorting_units().size(); ++s) {
    add(fmt::format("sorting{}", s), work_of(accelerator.sorting_units()[s]->counters()));
  }
  for (std::size_t s = 0; s < accelerator.key_sorters().size(); ++s) {
    add(fmt::format("sorting{}", s), work_of(accelerator.key_sorters()[s]->counters()));
  }
  if (accelerator.codebooks() != nullptr) {
    add("codebooks.load", work_of(accelerator.codebooks()->counters()));
  }
  if (accelerator.merge() != nullptr) add("merge", work_of(accelerator.merge()->counters()));
  add("rendering.blend", work_of(accelerator.rendering().counters()));
  return units;
}

Json traffic_of(const DramStats& stats, const std::vector<std::string>& requesters) {
  Json bytes;
  for (const auto& row : stats.traffic.rows()) {
    bytes[kRegionNames[row.region]][requesters[row.requester]]
         [row.direction == Direction::kRead ? "read" : "write"] = row.count.bytes;
  }
  return bytes;
}

Json dram_of(Accelerator& accelerator) {
  const DramStats stats = accelerator.dram().stats();
  const DramChannelStats all = stats.all_channels();
  const auto latency_ns = [&](double fraction) {
    return static_cast<double>(stats.read_latency_cycles.percentile(fraction)) *
           stats.clock_period_ns;
  };
  Json by_region;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    by_region[kRegionNames[region]] =
        (stats.bursts_by_region[region][0] + stats.bursts_by_region[region][1]) * stats.burst_bytes;
  }
  return {{"bytes", stats.bytes()},
          {"bus_bytes", stats.bus_bytes()},
          {"bytes_by_region", traffic_of(stats, accelerator.requesters())},
          {"bus_bytes_by_region", by_region},
          {"transactions", stats.traffic.total().transactions},
          {"row_hits", all.rows.of(RowOutcome::kHit)},
          {"row_misses", all.rows.of(RowOutcome::kMiss)},
          {"row_conflicts", all.rows.of(RowOutcome::kConflict)},
          {"refreshes", all.refreshes()},
          {"bandwidth_gb_s", stats.bandwidth_gb_per_s()},
          {"busy_bandwidth_gb_s", stats.busy_bandwidth_gb_per_s()},
          {"peak_gb_s", stats.peak_gb_per_s},
          {"of_peak", stats.bandwidth_gb_per_s() / stats.peak_gb_per_s},
          {"read_latency_mean_ns", stats.read_latency_cycles.mean() * stats.clock_period_ns},
          {"read_latency_p50_ns", latency_ns(0.5)},
          {"read_latency_p99_ns", latency_ns(0.99)}};
}

Json sram_of(const AcceleratorConfig& config, const SecondHalfFormat& format) {
  const SramBudget budget = sram_budget(config);
  const auto list = [](const std::vector<SramUse>& uses) {
    Json out = Json::array();
    for (const SramUse& use : uses) {
      out.push_back({{"name", use.name}, {"bytes", use.bytes}, {"arithmetic", use.arithmetic}});
    }
    return out;
  };
  return {{"input_bytes", SramBudget::total(budget.input)},
          {"input_available_bytes", config.sram.input_bytes},
          {"codebook_bytes", format.codebook_bytes()},
          {"codebook_available_bytes", config.sram.codebook_bytes},
          {"shared_bytes", SramBudget::total(budget.shared)},
          {"shared_available_bytes", config.sram.shared_bytes},
          {"uses", list(budget.shared)}};
}

}  // namespace

std::string measure(Accelerator& accelerator) {
  const std::uint64_t cycles = accelerator.frame_cycles();
  const double time_s = static_cast<double>(cycles) / (accelerator.config().clock_mhz * 1e6);
  const Binding binding = find_binding(accelerator);
  Json out;
  out["frame"] = {{"cycles", cycles},
                  {"time_s", time_s},
                  {"fps", 1 / time_s},
                  {"drained", accelerator.drained()}};
  out["units"] = units_of(accelerator);
  out["binding"] = {{"unit", binding.unit},
                    {"utilisation", binding.utilisation},
                    {"next", binding.next},
                    {"next_utilisation", binding.next_utilisation},
                    {"explanation", binding.explanation}};
  out["dram"] = dram_of(accelerator);
  out["energy"] = energy_of(accelerator);
  out["area_mm2"] = area_of(accelerator);
  out["sram"] = sram_of(accelerator.config(), accelerator.job().layout.second_half);
  return out.dump();
}

}  // namespace sgs
