// The report's sections, each from a part of the result.
#include "testbench/streaminggs/report/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithm/image/quality.h"
#include "algorithm/storage/storage_scheme.h"
#include "testbench/result/ledger.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: equal pictures report null and say so by max_abs_error 0.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// {name + suffix: value, ...}
template <class Pairs>
Json object_of(const Pairs& pairs, const char* suffix = "") {
  Json out = Json::object();
  for (const auto& [name, value] : pairs) out[name + suffix] = value;
  return out;
}

Json scene_of(const PreparedScene& scene) {
  const SceneLayout& layout = scene.stored.image.layout;
  const SecondHalfFormat& format = layout.second_half;
  Json codebooks = Json::object();
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    codebooks[kCodebookNames[id]] = {{"entries", format.entries[id]},
                                     {"words", codebook_words(codebook, format.sh_degree)},
                                     {"bytes", format.entries[id] * format.entry_bytes(codebook)}};
  }
  Json out = {{"name", scene.name},
              {"gaussians", scene.stored.gaussians},
              {"sh_degree", layout.sh_degree()},
              {"dropped_invalid", scene.dropped_invalid}};
  const StorageScheme& scheme = scheme_of(layout.order());
  out["stored_by"] = scheme.name();
  for (const auto& [name, value] : scheme.facts(layout.table)) {
    std::visit([&, key = name](auto number) { out[key] = number; }, value);
  }
  out["second_half_bytes"] = layout.second_halves.record_bytes;
  out["codebooks"] = codebooks;
  out["stored_bytes"] = layout.stored_bytes;
  return out;
}

// As the frame has it: rows of `rotation` as in cameras.json.
Json camera_of(const Camera& camera) {
  const glm::dmat3& r = camera.world_from_camera;
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) rotation.push_back({r[0][row], r[1][row], r[2][row]});
  Json out = {{"id", camera.id},
              {"img_name", camera.name},
              {"fx_px", camera.focal_x},
              {"fy_px", camera.focal_y},
              {"position", {camera.position.x, camera.position.y, camera.position.z}},
              {"rotation", rotation}};
  if (camera.principal_offset != glm::dvec2(0)) {
    out["cx_px"] = 0.5 * camera.width + camera.principal_offset.x;
    out["cy_px"] = 0.5 * camera.height + camera.principal_offset.y;
  }
  return out;
}

Json error_parts_of(const OrderLoss& loss) {
  const auto part = [](const ErrorPart& p) -> Json {
    return {{"share", finite(p.share)}, {"alone", finite(p.alone)}};
  };
  Json out;
  if (loss.encoding) out["encoding"] = part(*loss.encoding);
  out["missed"] = part(loss.missed);
  out["misordered"] = part(loss.misordered);
  if (loss.arithmetic) out["arithmetic"] = part(*loss.arithmetic);
  out["pixel_format"] = part(loss.pixel_format);
  return out;
}

Json file_order_of(const std::optional<FileOrderDifference>& difference) {
  if (!difference) return nullptr;
  return {{"psnr_db", finite(difference->psnr_db)},
          {"max_abs_error", difference->max_abs_error},
          {"pixels", difference->pixels}};
}

Json image_of(const ViewResult& view, bool original_known) {
  const GoldenFrame& golden = view.golden;
  Json out = {{"reference", original_known ? "scene" : "decoded_scene"},
              {"empty", golden.contributing == 0},
              {"psnr_db", finite(view.psnr_db)},
              {"ssim", view.ssim},
              {"max_abs_error", max_abs_error(view.frame, view.reference)},
              {"decoded_psnr_db", finite(psnr_db(view.frame, view.decoded_reference))}};
  if (original_known) {
    out["encoding_psnr_db"] = finite(psnr_db(view.decoded_reference, view.reference));
  }
  out["file_order"] = file_order_of(view.file_order);
  out["equals_streaming_renderer"] = view.equals_golden;
  out["missed"] = golden.missed;
  out["misordered"] = golden.misordered;
  out["blends"] = golden.blends;
  if (view.order_loss) out["error_parts"] = error_parts_of(*view.order_loss);
  return out;
}

void add(Json& to, const Remedy& remedy) {
  if (remedy.known()) to["key"] = remedy.key;
  if (remedy.known()) to["turn"] = remedy.turn == Turn::kUp ? "up" : "down";
}

Json activity_of(const ActivityResult& activity) {
  Json waited = Json::object();
  for (std::size_t k = 0; k < kWaitForCount; ++k) {
    const auto what = static_cast<WaitFor>(k);
    waited[name_of(what)] = activity.waited_for(what);
  }
  Json waits = Json::array();
  for (const WaitResult& wait : activity.waits) {
    Json& out = waits.emplace_back(Json{{"for", name_of(wait.what)}, {"cycles", wait.cycles}});
    if (!wait.at.empty()) out["on"] = wait.at;
    if (!wait.other.empty()) out["other_end"] = wait.other;
    add(out, wait.remedy);
  }
  Json out = {{"resource", activity.resource},
              {"busy_cycles", activity.busy_cycles},
              {"waited_cycles", waited},
              {"waits", waits}};
  add(out, activity.remedy);
  return out;
}

Json units_of(const MachineResult& machine) {
  Json units = Json::object();
  for (const UnitResult& unit : machine.units) {
    Json& out = units[unit.name];
    out["activities"] = Json::object();
    for (const ActivityResult& a : unit.activities) {
      out["activities"][a.name] = activity_of(a);
    }
    out["counters"] = Json::object();
    for (const CounterResult& c : unit.counters) out["counters"][c.name] = c.value;
  }
  return units;
}

Json dram_of(const MemoryResult& m) {
  Json traffic = Json::object();
  for (const RegionTraffic& t : m.traffic) {
    Json& out = traffic[t.region][t.requester];
    if (t.read_bytes > 0) out["read"] = t.read_bytes;
    if (t.written_bytes > 0) out["write"] = t.written_bytes;
  }
  return {{"bytes", m.bytes},
          {"bus_bytes", m.bus_bytes},
          {"bytes_by_region", traffic},
          {"bus_bytes_by_region", object_of(m.bus_bytes_by_region)},
          {"transactions", m.transactions},
          {"row_hits", m.row_hits},
          {"row_misses", m.row_misses},
          {"row_conflicts", m.row_conflicts},
          {"refreshes", m.refreshes},
          {"bandwidth_gb_s", m.bandwidth_gb_s},
          {"busy_bandwidth_gb_s", m.busy_bandwidth_gb_s},
          {"peak_gb_s", m.peak_gb_s},
          {"of_peak", m.bandwidth_gb_s / m.peak_gb_s},
          {"read_latency_mean_ns", m.read_latency_mean_ns},
          {"read_latency_p50_ns", m.read_latency_p50_ns},
          {"read_latency_p99_ns", m.read_latency_p99_ns}};
}

Json band_of(const Band& band) {
  return {{"low", band.low}, {"middle", band.middle}, {"high", band.high}};
}

// Middle values, and beside them what the sources allow.
Json costs_of(const CostResult& cost, const char* suffix) {
  Json out = Json::object(), bands = Json::object();
  for (const auto& [component, amount] : cost.by_component) {
    out[component + suffix] = amount.middle;
    bands[component + suffix] = band_of(amount);
  }
  out[std::string("total") + suffix] = cost.total.middle;
  bands[std::string("total") + suffix] = band_of(cost.total);
  out["bands"] = bands;
  return out;
}

Json energy_section(const ViewResult& view) {
  Json out = costs_of(view.energy_j, "_j");
  out["mean_power_w"] = view.mean_power_w();
  out["dram_by_current_set_j"] = object_of(view.run.memory.energy_by_current_set_j);
  out["dram_by_region_j"] = object_of(view.run.memory.energy_by_region_j);
  return out;
}

Json sram_of(const MachineResult& machine, const SramModel& model) {
  Json out;
  for (const auto& [memory, available] : machine.sram_available) {
    out[memory + "_bytes"] = sram_bytes(machine.sram_uses, memory);
    out[memory + "_available_bytes"] = available;
  }
  out["uses"] = Json::array();
  for (const SramUse& use : machine.sram_uses) {
    out["uses"].push_back({{"name", use.name},
                           {"memory", use.memory},
                           {"bytes", use.total_bytes()},
                           {"built_as", use.in_registers() ? "registers" : "sram"},
                           {"arithmetic", use.product()},
                           {"memories", use.count * use.shape.banks},
                           {"width_bits", use.shape.width_bits},
                           {"mm2", model.mm2(use).middle}});
    for (const SramAccesses& a : machine.sram_accesses) {
      if (a.use != use.name) continue;
      Json& line = out["uses"].back();
      line["reads"] = a.reads;
      line["writes"] = a.writes;
      line["energy_j"] = access_energy_j(machine, use, model).middle;
    }
  }
  return out;
}

Json datapaths_of(const std::vector<DatapathResult>& datapaths) {
  Json out = Json::object();
  for (const auto& [d, items, busiest] : datapaths) {
    const auto cost = [&, lanes = d.lanes](std::uint32_t macs) -> Json {
      return {{"macs", macs}, {"interval_cycles", (macs + lanes - 1) / lanes}};
    };
    Json& line = out[d.name];
    line = {{"lane", d.lane},
            {"lanes", d.all_lanes()},
            {"items", items},
            {"counts", object_of(d.counts)},
            {"counted", cost(d.counted_macs)}};
    if (d.published_macs > 0) line["paper"] = cost(d.published_macs);
    line["used"] = cost(d.used_macs);
    for (const BesideLanes& beside : d.beside) {
      line["beside"][beside.kind] = {{"operations", beside.operations}, {"parts", d.parts(beside)}};
    }
    const auto between = [&, copies = d.copies](const char* kind, std::uint32_t bits,
                                                std::uint32_t of_item) {
      if (bits == 0) return;
      line["beside"][kind] = {{"operations", of_item}, {"parts", std::uint64_t{copies} * bits}};
    };
    between("register_bit", d.between.registers, d.between.written);
    between("select_bit", d.between.multiplexers, d.between.selected);
    line["depth_cycles"] = d.depth_cycles;
  }
  return out;
}

Json ledger_section(const FrameResult& run) {
  Json lines = Json::array();
  for (const LedgerLine& line : ledger_of(run.machine)) {
    lines.push_back({{"what", line.what},
                     {"done", line.done},
                     {"per_cycle", line.per_cycle},
                     {"utilisation", line.utilisation(run.cycles)}});
  }
  return {{"lines", lines}, {"faults", ledger_faults(run.machine, run.cycles)}};
}

Json left_out_section(const std::vector<LeftOut>& list) {
  Json out = Json::array();
  for (const LeftOut& entry : list) {
    out.push_back(
        {{"what", entry.what}, {"why", entry.why}, {"count", entry.count}, {"saves", entry.saves}});
  }
  return out;
}

}  // namespace

Json view_report(const ViewResult& view, const PreparedScene& scene) {
  const FrameResult& run = view.run;
  Json report;
  report["schema_version"] = kReportVersion;
  report["scene"] = scene_of(scene);
  report["view"] = view.view;
  report["camera"] = camera_of(view.camera);
  report["image"] = image_of(view, scene.stored.original_known());
  report["frame"] = {
      {"cycles", run.cycles},          {"time_s", run.time_s()},          {"fps", 1 / run.time_s()},
      {"width_px", view.camera.width}, {"height_px", view.camera.height}, {"drained", run.drained}};
  report["units"] = units_of(run.machine);
  report["binding"] = {
      {"unit", view.binding.unit},   {"utilisation", view.binding.utilisation},
      {"next", view.binding.next},   {"next_utilisation", view.binding.next_utilisation},
      {"holds", view.binding.holds}, {"explanation", view.binding.sentence()}};
  add(report["binding"], view.binding.remedy);
  report["dram"] = dram_of(run.memory);
  report["energy"] = energy_section(view);
  report["area_mm2"] = costs_of(view.area_mm2, "");
  report["sram"] = sram_of(run.machine, view.sram_model);
  report["datapath"] = datapaths_of(run.machine.datapaths);
  report["ledger"] = ledger_section(run);
  report["limit"] = {{"contributing_gaussians", view.golden.contributing},
                     {"bytes_read_once", view.once_bytes},
                     {"ratio", view.once_ratio()}};
  report["left_out"] = left_out_section(view.left_out);
  report["host"] = {{"simulation_wall_s", run.wall_s}};
  return report;
}

}  // namespace sgs
