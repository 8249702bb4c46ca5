// Tables of numbers for people.
#include "testbench/streaminggs/report/terminal.h"

#include <fmt/format.h>

#include <cmath>

#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

// 0.1234 -> "12.3 %"
std::string percent(double share) {
  return std::isnan(share) ? "none" : fmt::format("{:.1f} %", 100 * share);
}

// "vsu 0.37, merge 0.08"
std::string in_words(const CostResult& area) {
  std::string parts;
  for (const auto& [component, mm2] : area.by_component) {
    parts += fmt::format("{}{} {:.2f}", parts.empty() ? "" : ", ", component, mm2.middle);
  }
  return parts;
}

constexpr const char* kWithoutMemory = " without the memory";

// "2.110", or ">2.110" of what the memory's is not part of.
std::string at_least(const ViewResult& v, double value) {
  return fmt::format("{}{:.3f}", v.run.memory.energy_not_stated.empty() ? "" : ">", value);
}

// Prints the parts of the squared error that the machine and the storage cause.
void print_order_loss(const OrderLoss& loss, const GoldenFrame& golden) {
  fmt::print("  squared error: ");
  if (golden.missed > 0) fmt::print("missed splats {}, ", percent(loss.missed.share));
  if (loses_order(golden)) fmt::print("misordered blends {}, ", percent(loss.misordered.share));
  if (loss.arithmetic) fmt::print("arithmetic {}, ", percent(loss.arithmetic->share));
  fmt::print("encoding {}, pixel format {}\n",
             loss.encoding ? percent(loss.encoding->share) : "not known: packed",
             percent(loss.pixel_format.share));
}

}  // namespace

void print_table_head(Detail detail) {
  fmt::print("{:>4} {:>9} {:>8} {:>8} {:>20} {:>13} {:>7} {:>8} {:>8} {:>8}", "view", "px",
             "PSNR dB", "SSIM", "= streaming renderer", "cycles", "fps", "DRAM MB", "bus MB", "mJ");
  if (detail == Detail::kAll) {
    fmt::print(" {:>6} {:>7} {:>10} {:>5} {:>7}", "x once", "W", "binding", "busy", "wall s");
  }
  fmt::print("\n");
}

void print_table_line(const ViewResult& v, Detail detail) {
  fmt::print("{:>4} {:>9} {:>8} {:>8.5f} {:>20} {:>13} {:>7} {:>8.2f} {:>8.2f} {:>8}", v.view,
             fmt::format("{}x{}", v.camera.width, v.camera.height),
             std::isinf(v.psnr_db) ? "equal" : fmt::format("{:.2f}", v.psnr_db), v.ssim,
             v.equals_golden ? "yes" : "NO", grouped(v.run.cycles),
             rate_in_words(1 / v.run.time_s()), static_cast<double>(v.run.memory.bytes) / 1e6,
             static_cast<double>(v.run.memory.bus_bytes) / 1e6,
             at_least(v, v.energy_j.total.middle * 1e3));
  if (detail == Detail::kAll) {
    fmt::print(" {:>6.2f} {:>7} {:>10} {:>4.0f}% {:>7.2f}", v.once_ratio(),
               at_least(v, v.mean_power_w()), v.binding.unit, 100 * v.binding.utilisation,
               v.run.wall_s);
  }
  fmt::print("\n");
}

void print_bottleneck(const ViewResult& v) {
  fmt::print("view {}: {}\n", v.view, v.binding.sentence());
  if (is_empty(v)) {
    fmt::print("view {}: no Gaussian contributes to the picture\n", v.view);
  }
}

void print_right_eye(const ViewResult& v) {
  if (!v.right) return;
  fmt::print(
      "view {}: right eye, {:g} world units beside the left one: {}, SSIM {:.5f}; cycles, bytes "
      "and "
      "joules are of both pictures, and frames a second are pairs\n",
      v.view, v.camera.eyes_apart,
      std::isinf(v.right->psnr_db) ? "equal" : fmt::format("{:.2f} dB", v.right->psnr_db),
      v.right->ssim);
  for (std::size_t eye = 0; eye < 2 && !is_empty(v); ++eye) {
    if (v.golden.contributing_of[eye] > 0) continue;
    fmt::print("view {}: the {} eye sees no Gaussian: their distance is in the scene's units\n",
               v.view, eye == 0 ? "left" : "right");
  }
}

void print_empty(std::size_t empty, std::size_t all, const char* what) {
  if (empty > 0) fmt::print("{} of {} {} hold no Gaussian\n", empty, all, what);
}

void print_energy(const ViewResult& v) {
  const MemoryResult& dram = v.run.memory;
  const Band dram_j{dram.energy_least_j, dram.energy_j, dram.energy_most_j};
  const auto in_mj = [](const Band& joules) {
    return fmt::format("{:.3f} ({:.3f} .. {:.3f}) mJ", 1e3 * joules.middle, 1e3 * joules.low,
                       1e3 * joules.high);
  };
  const bool known = dram.energy_not_stated.empty();
  const Totals& totals = v.energy_totals_j;
  fmt::print("view {}: energy {}{}; {} with PHY and controller\n", v.view,
             in_mj(totals.without_memory_interface),
             known ? ", of it DRAM " + in_mj(dram_j) : kWithoutMemory,
             in_mj(totals.with_memory_interface));
}

void print_unknown_energy(const ViewResult& v) {
  std::string lacks = v.run.memory.energy_not_stated;
  for (const FixedRate& rate : v.fixed_rates)
    if (lacks.empty()) lacks = rate.memory_not_stated;
  if (lacks.empty()) return;
  fmt::print("the memory's energy is not known: {} does not state {}\n", v.memory_interface.memspec,
             lacks);
}

std::string rounded(const Band& band) {
  return fmt::format("{} ({} .. {})", rounded(band.middle), rounded(band.low), rounded(band.high));
}

void print_fixed_rates(const ViewResult& v) {
  for (const FixedRate& rate : v.fixed_rates) {
    if (!rate.held) {
      fmt::print("view {}: does not hold {} frames a second: a frame takes {} ms\n", v.view,
                 rounded(rate.per_s), rounded(1e3 * v.run.time_s()));
      continue;
    }
    const Totals watts = rate.totals_w();
    const double frame_j = v.energy_totals_j.without_memory_interface.middle;
    const double both_j = rate.totals_j.without_memory_interface.middle;
    const char* memory = rate.memory_not_stated.empty() ? "" : kWithoutMemory;
    fmt::print(
        "view {}: at {} frames a second {} W{}: {} mJ a frame, {} mJ in {} ms of rest\n"
        "  of the rest the memory is {} in self-refresh, {} in power-down; the band's high end is "
        "all "
        "in power-down\n"
        "  with PHY and controller {} W{}: they take {} W in the rest\n",
        v.view, rounded(rate.per_s), rounded(watts.without_memory_interface), memory,
        rounded(1e3 * frame_j), rounded(1e3 * (both_j - frame_j)), rounded(1e3 * rate.rest_s),
        percent(rate.self_refresh_s / rate.rest_s), percent(rate.power_down_s / rate.rest_s),
        rounded(watts.with_memory_interface), memory, rounded(rate.memory_interface_w));
  }
}

void print_losses(const ViewResult& v) {
  if (v.file_order && v.file_order->pixels > 0) {
    fmt::print(
        "  ties of depth in the file's order: {} pixels of the reference picture differ, {:.2f} "
        "dB, by at most {:.2g}\n",
        grouped(v.file_order->pixels), v.file_order->psnr_db, v.file_order->max_abs_error);
  }
  if (v.order_loss) print_order_loss(*v.order_loss, v.golden);
}

void print_regions(const ViewResult& v) {
  fmt::print("  {:<14} {:>14} {:>14}\n", "DRAM region", "B requested", "B on the bus");
  for (const auto& [region, bus_bytes] : v.run.memory.bus_bytes_by_region) {
    std::uint64_t asked = 0;
    for (const RegionTraffic& t : v.run.memory.traffic) {
      if (t.region == region) asked += t.read_bytes + t.written_bytes;
    }
    if (asked == 0 && bus_bytes == 0) continue;
    fmt::print("  {:<14} {:>14} {:>14}\n", region, grouped(asked), grouped(bus_bytes));
  }
}

void print_scene(const PreparedScene& scene, const RunConfig& config, bool dropping) {
  if (dropping || scene.dropped_invalid > 0) {
    fmt::print("\ndropped invalid: {} Gaussians, {} are left\n", grouped(scene.dropped_invalid),
               grouped(scene.stored.gaussians));
  }
  if (!config.storage_source.empty()) fmt::print("\n{}\n", config.storage_source);
  if (!scene.stored.original_known()) {
    fmt::print(
        "PSNR and SSIM are against the decoded scene: what its encoding costs is not known\n");
  }
}

void print_area(const ViewResult& v, const std::string& technology, Detail detail) {
  const MemoryInterface& interface = v.memory_interface;
  const std::string stated =
      v.stated_area_mm2 > 0 ? fmt::format(", {:.2f} stated", v.stated_area_mm2) : "";
  fmt::print("area {} mm2 at {}{}; {} with PHY and controller of {}\n",
             in_words(v.area_totals_mm2.without_memory_interface), technology, stated,
             in_words(v.area_totals_mm2.with_memory_interface), interface.whose());
  if (!interface.area_known || detail == Detail::kAll) fmt::print("{}\n", interface.in_words());
  if (detail == Detail::kShort) return;
  fmt::print("  mm2 by kind: {}\n", in_words(v.area_mm2));
  fmt::print("  mm2 by owner, with its on-chip memory: {}\n", in_words(v.area_by_owner_mm2));
}

void print_lanes(const ViewResult& v) {
  for (const auto& [d, items, busiest] : v.run.machine.datapaths) {
    const std::string published =
        d.published_macs > 0 ? fmt::format(" {} published,", d.published_macs) : "";
    const std::string of = d.lanes_of.empty() ? "" : " of " + d.lanes_of;
    fmt::print("{}: {} lanes{} ({}); multiply-accumulates each: {} counted,{} {} charged\n", d.name,
               d.all_lanes(), of, d.lane, d.counted_macs, published, d.used_macs);
  }
}

void print_choices(const std::vector<AutoChoice>& chosen, Detail detail) {
  if (detail == Detail::kShort && !chosen.empty()) {
    fmt::print("{} values chosen by the model: --verbose lists them\n", chosen.size());
    return;
  }
  for (const AutoChoice& choice : chosen) {
    fmt::print("chosen: {} {:g}: {}\n", choice.key, choice.value, choice.why);
  }
}

}  // namespace sgs
