// Energy and area from counts.
#include "testbench/streaminggs/energy.h"

#include <nlohmann/json.hpp>

#include "algorithm/memory/splat_record.h"
#include "modules/accelerator.h"
#include "modules/sorting/sorting_cost.h"
#include "testbench/streaminggs/energy_constants.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPj = 1e-12;

// A byte written once and read once.
double through_sram_pj(double bytes, double pj_per_bit) {
  return bytes * 8 * pj_per_bit * (1 + kWriteOverRead);
}

double count(std::uint64_t value) { return static_cast<double>(value); }

// What the two orders count under different names.
struct Work {
  double vsu_macs = 0;
  double coarse_tests = 0, fine_tests = 0;
  double first_halves = 0, second_halves = 0, splats = 0;
  double compare_exchanges = 0;
  double keys = 0;  // through the merge unit
};

Work work_of(const Accelerator& a) {
  Work w;
  if (a.vsu() != nullptr) w.vsu_macs = count(a.vsu()->counters().steps) * kRayStepMacs;
  if (a.chunk_vsu() != nullptr) {
    w.vsu_macs = count(a.chunk_vsu()->counters().tests) * kChunkTestMacs;
  }
  for (const auto& hfu : a.hfus()) {
    const HfuCounters c = hfu->counters();
    w.coarse_tests += count(c.coarse_tests);
    w.fine_tests += count(c.fine_tests);
    w.first_halves += count(c.first_halves);
    w.second_halves += count(c.second_halves);
    w.splats += count(c.splats);
  }
  for (const auto& unit : a.sorting_units()) {
    w.compare_exchanges += count(unit->counters().compare_exchanges);
  }
  for (const auto& unit : a.key_sorters()) {
    w.compare_exchanges += count(unit->counters().compare_exchanges);
  }
  if (a.merge() != nullptr) w.keys = count(a.merge()->counters().keys);
  return w;
}

double sram_kb(const AcceleratorConfig& config) {
  return (count(config.sram.input_bytes) + count(config.sram.codebook_bytes) +
          count(config.sram.shared_bytes)) /
         1024;
}

}  // namespace

Json energy_of(Accelerator& accelerator) {
  const AcceleratorConfig& config = accelerator.config();
  const Work w = work_of(accelerator);
  const RenderingCounters& r = accelerator.rendering().counters();
  const DramStats dram = accelerator.dram().stats();
  const double time_s = count(accelerator.frame_cycles()) / (config.clock_mhz * 1e6);

  const double subtiles = count(r.subtile_blends);
  // A key climbs or sinks through the levels of the heap, once in and once out.
  const double heap_levels = merge_levels(config.merge.entries);
  Json e;
  e["vsu_j"] = w.vsu_macs * kMacPj * kPj;
  e["coarse_j"] = w.coarse_tests * config.hfu.cfu_macs * kMacPj * kPj;
  e["fine_j"] = w.fine_tests * config.hfu.ffu_macs * kMacPj * kPj;
  e["sorting_j"] = w.compare_exchanges * kCompareExchangePj * kPj;
  e["merge_j"] =
      through_sram_pj(w.keys * 2 * heap_levels * kWaitingKeyBytes, kMiddleSramPjPerBit) * kPj;
  e["rendering_j"] = subtiles * kSubtilePixels * kPixelBlendPj * kPj;
  e["pixel_state_j"] =
      through_sram_pj(subtiles * kSubtilePixels * kPixelStateBytes, kLargeSramPjPerBit) * kPj;
  e["buffers_j"] =
      through_sram_pj(w.first_halves * kFirstHalfBytes +
                          w.second_halves * accelerator.job().layout.second_half_bytes() +
                          w.splats * kSplatEntryBytes,
                      kSmallSramPjPerBit) *
      kPj;
  if (accelerator.codebooks() != nullptr) {
    const CodebookCounters& c = accelerator.codebooks()->counters();
    e["codebooks_j"] =
        8 * kLargeSramPjPerBit *
        (count(c.lines) * config.codebook.line_bytes + count(c.bytes_loaded) * kWriteOverRead) *
        kPj;
  }
  e["sram_leakage_j"] = sram_kb(config) * kSramLeakageMwPerKb * 1e-3 * time_s;
  e["dram_j"] = dram.energy.total_pj() * kPj;
  double total = 0;
  for (const auto& component : e) total += component.get<double>();
  e["total_j"] = total;
  e["mean_power_w"] = time_s > 0 ? total / time_s : 0;
  for (const auto& [set, pj] : dram.energy_by_current_set_pj)
    e["dram_by_current_set_j"][set] = pj * kPj;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    e["dram_by_region_j"][kRegionNames[region]] = dram.energy.by_region_pj[region] * kPj;
  }
  e["dram_by_region_j"]["standby_and_refresh"] = dram.energy.shared_pj * kPj;
  return e;
}

Json area_of(const Accelerator& accelerator) {
  const AcceleratorConfig& c = accelerator.config();
  Json a;
  a["vsu"] = kVsuMm2;
  a["hfus"] = c.hfus * (c.hfu.cfus * c.hfu.cfu_lanes + c.hfu.ffu_lanes) * kMacLaneMm2;
  a["sorting"] = c.sorting_units * kSortingUnitMm2;
  // Not published: taken as one more sorting unit.
  a["merge"] = c.ordering == Ordering::kExact ? kSortingUnitMm2 : 0.0;
  a["rendering"] = c.rendering.clusters * kSubtilePixels * kPixelLaneMm2;
  a["sram"] = sram_kb(c) * kSramMm2PerKb;
  double total = 0;
  for (const auto& component : a) total += component.get<double>();
  a["total"] = total;
  return a;
}

}  // namespace sgs
