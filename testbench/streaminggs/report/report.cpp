// The report's sections, each from a part of the result.
#include "testbench/streaminggs/report/report.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "algorithm/image/quality.h"
#include "algorithm/storage/storage_scheme.h"
#include "testbench/result/ledger.h"
#include "testbench/streaminggs/report/report_visitor.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;
using Key = ReportVisitor::Key;

// JSON has no infinity: equal pictures report null and say so by max_abs_error 0.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void visit_codebooks(ReportVisitor& r, const SecondHalfFormat& format) {
  r.object("codebooks", [&] {
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      if (!r.has(format.entries[id] > 0)) continue;
      const auto codebook = static_cast<Codebook>(id);
      r.object({"CODEBOOK", kCodebookNames[id]}, [&] {
        r("entries", "", "Entries of this codebook.", format.entries[id]);
        r("words", "", "Numbers in an entry.", codebook_words(codebook, format.sh_degree));
        r("bytes", "B", "Size of this codebook.",
          format.entries[id] * format.entry_bytes(codebook));
      });
    }
  });
}

void visit_facts(ReportVisitor& r, const StorageScheme& scheme, const TableLayout& table) {
  for (const StorageFact& fact : scheme.facts(table)) {
    std::visit([&](auto number) { r(fact.key, fact.unit, fact.meaning, number); }, fact.value);
  }
}

void visit_scene(ReportVisitor& r, const PreparedScene& scene) {
  const SceneLayout& layout = scene.stored.image.layout;
  const StorageScheme& scheme = scheme_of(layout.order());
  r("name", "", "Name of the scene.", scene.name);
  r("gaussians", "", "Gaussians in the file, without those that were dropped.",
    scene.stored.gaussians);
  r("sh_degree", "0..3", "Degree of the stored colours.", layout.sh_degree());
  r("dropped_invalid", "", "Gaussians that `--drop-invalid` left out.", scene.dropped_invalid);
  if (r.has(!scene.axes.empty())) {
    r("axes", "",
      "Where x, y and z of the file point, before the scene was turned to right, down, forward.",
      scene.axes);
  }
  r("stored_by", "", "Storage order: `chunks`, `voxels` or `file`.", scheme.name());
  if (r.telling()) {
    for (const StorageScheme* any : {&voxel_scheme(), &chunk_scheme(), &file_scheme()}) {
      visit_facts(r, *any, any->empty_table());
    }
  } else {
    visit_facts(r, scheme, layout.table);
  }
  r("second_half_bytes", "B", "Size of one second half in this encoding.",
    layout.second_halves.record_bytes);
  visit_codebooks(r, layout.second_half);
  r("stored_bytes", "B", "Size of the scene in DRAM: tables, both halves and codebooks.",
    layout.stored_bytes);
}

void visit_camera(ReportVisitor& r, const Camera& camera) {
  const glm::dmat3& axes = camera.world_from_camera;
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) rotation.push_back({axes[0][row], axes[1][row], axes[2][row]});
  r("id", "", "Number that the cameras' file gives it.", camera.id);
  r("img_name", "", "Name that the cameras' file gives it.", camera.name);
  r("fx_px", "px", "Horizontal focal length of the frame, after `--size`.", camera.focal_x);
  r("fy_px", "px", "Vertical focal length of the frame, after `--size`.", camera.focal_y);
  r("position", "world units", "Centre of the camera: x, y, z.",
    Json{camera.position.x, camera.position.y, camera.position.z});
  r("rotation", "",
    "Rows of a matrix whose columns are the axes right, down and forward, in the world.", rotation);
  if (!r.has(camera.principal_offset != glm::dvec2(0))) return;
  r("cx_px", "px", "Principal point from the left edge; none where it is in the middle.",
    0.5 * camera.width + camera.principal_offset.x);
  r("cy_px", "px", "Principal point from the top edge; none where it is in the middle.",
    0.5 * camera.height + camera.principal_offset.y);
}

void visit_error_part(ReportVisitor& r, const char* step, const ErrorPart& part) {
  r.object({"STEP", step}, [&] {
    r("share", "ratio",
      "This step's part of the squared error; all add up to 1. `null` where pictures are equal.",
      finite(part.share));
    r("alone", "ratio",
      "This step's own square over the squared error. `null` where pictures are equal.",
      finite(part.alone));
  });
}

void visit_error_parts(ReportVisitor& r, const OrderLoss& loss) {
  r.object("error_parts", [&] {
    if (loss.encoding) visit_error_part(r, "encoding", *loss.encoding);
    visit_error_part(r, "missed", loss.missed);
    visit_error_part(r, "misordered", loss.misordered);
    if (loss.arithmetic) visit_error_part(r, "arithmetic", *loss.arithmetic);
    visit_error_part(r, "pixel_format", loss.pixel_format);
  });
}

void visit_file_order(ReportVisitor& r, const std::optional<FileOrderDifference>& difference) {
  if (r.has(!difference)) {
    r("file_order", "", "`null` for a packed scene: the order of its file is not known.", nullptr);
  }
  r.each(difference, [&](const FileOrderDifference& d) {
    r.object("file_order", [&] {
      r("psnr_db", "dB",
        "Reference picture, with ties of depth by storage slot, against ties in the file's order. "
        "`null`: equal.",
        finite(d.psnr_db));
      r("max_abs_error", "linear", "Largest difference of a channel between these two pictures.",
        d.max_abs_error);
      r("pixels", "", "Pixels that differ between them.", d.pixels);
    });
  });
}

void visit_image(ReportVisitor& r, const ViewResult& view, bool original_known) {
  const GoldenFrame& golden = view.golden;
  r("reference", "",
    "Scene that the reference picture shows: `scene`, as given; `decoded_scene`, where it was "
    "packed in an encoding that loses.",
    original_known ? "scene" : "decoded_scene");
  r("empty", "bool",
    "No Gaussian contributes: the picture is background, and equality says nothing.",
    golden.contributing == 0);
  r("psnr_db", "dB",
    "Frame against reference picture, both clamped to 0..1. `null`: infinite, they are equal.",
    finite(view.psnr_db));
  r("ssim", "0..1", "Frame against reference picture, both clamped to 0..1.", view.ssim);
  r("max_abs_error", "linear",
    "Largest difference of a channel, not clamped: rgb8 frames differ where the picture is "
    "brighter than 1.",
    [&] { return max_abs_error(view.frame, view.reference); });
  r("decoded_psnr_db", "dB",
    "Frame against the reference picture of the scene as encoded: the cost of order and pixel "
    "format.",
    [&] { return finite(psnr_db(view.frame, view.decoded_reference)); });
  if (r.has(original_known)) {
    r("encoding_psnr_db", "dB",
      "The reference picture of the scene as encoded against that of the scene as given: the cost "
      "of encoding.",
      [&] { return finite(psnr_db(view.decoded_reference, view.reference)); });
  }
  visit_file_order(r, view.file_order);
  r("equals_streaming_renderer", "bool",
    "The frame buffer equals the golden renderer's to the byte: `= model` on the terminal.",
    view.equals_golden);
  r("missed", "",
    "Pairs of a group and a splat that touches it from a voxel that none of its rays crosses.",
    golden.missed);
  r("misordered", "", "Blends behind a splat that is farther away, at the same pixel.",
    golden.misordered);
  r("blends", "", "Pairs of a splat and a pixel that it contributes to.", golden.blends);
  r.each(view.order_loss, [&](const OrderLoss& loss) { visit_error_parts(r, loss); });
}

void visit_remedy(ReportVisitor& r, const Remedy& remedy) {
  if (!r.has(remedy.known())) return;
  r("key", "", "Configuration key to change for fewer of these cycles, where one is known.",
    remedy.key);
  r("turn", "", "How to change that key: `up` or `down`.",
    remedy.turn == Turn::kUp ? "up" : "down");
}

const char* meaning_of(WaitFor what) {
  switch (what) {
    case WaitFor::kIdle:
      return "Cycles with nothing to do.";
    case WaitFor::kInput:
      return "Cycles of waiting for an entry of a FIFO.";
    case WaitFor::kReads:
      return "Cycles of waiting for answers to its reads.";
    case WaitFor::kWrites:
      return "Cycles of waiting for answers to its writes.";
    case WaitFor::kRoom:
      return "Cycles of waiting for a free entry of a FIFO or a buffer.";
    case WaitFor::kPort:
      return "Cycles of waiting for a free transaction of its port, or for the memory to take one.";
    case WaitFor::kLoading:
      return "Cycles of waiting for an on-chip memory to be loaded.";
    case WaitFor::kPhase:
      return "Cycles of waiting for its phase of the frame, while other units prepare memory.";
  }
  return "";
}

void visit_activity(ReportVisitor& r, const ActivityResult& activity) {
  r("resource", "", "Resource that it keeps busy.", activity.resource);
  r("busy_cycles", "cycles",
    "Cycles in which it worked. With all cycles of waiting they add up to the frame.",
    activity.busy_cycles);
  r.object("waited_cycles", [&] {
    for (std::size_t k = 0; k < kWaitForCount; ++k) {
      const auto what = static_cast<WaitFor>(k);
      r(name_of(what), "cycles", meaning_of(what), activity.waited_for(what));
    }
  });
  r.list("waits", activity.waits, [&](const WaitResult& wait) {
    r("for", "", "What it waited for: a key of `waited_cycles`.", name_of(wait.what));
    r("cycles", "cycles", "Cycles of waiting at this place.", wait.cycles);
    if (r.has(!wait.at.empty())) {
      r("on", "", "Path of the FIFO, port or unit; none for `idle` and `phase`.", wait.at);
    }
    if (r.has(!wait.other.empty())) {
      r("other_end", "", "Activity at the other end of that FIFO.", wait.other);
    }
    visit_remedy(r, wait.remedy);
  });
  visit_remedy(r, activity.remedy);
}

void visit_unit(ReportVisitor& r, const UnitResult& unit) {
  r.object("activities", [&] {
    r.each(unit.activities, [&](const ActivityResult& activity) {
      r.object({"ACTIVITY", activity.name}, [&] { visit_activity(r, activity); });
    });
  });
  r.object("counters", [&] {
    r.each(unit.counters, [&](const CounterResult& counter) {
      r({"COUNTER", counter.name}, "", "A count of this unit, with the unit's own meaning.",
        counter.value);
    });
  });
}

void visit_binding(ReportVisitor& r, const Binding& binding) {
  r("unit", "", "The busiest resource. `dram` is the data bus of the busiest channel.",
    binding.unit);
  r("utilisation", "0..1", "Its share of the frame.", binding.utilisation);
  r("next", "", "The second busiest resource.", binding.next);
  r("next_utilisation", "0..1", "The second one's share of the frame.", binding.next_utilisation);
  r("holds", "",
    "The bottleneck: the busiest resource, or, where none is busy enough, the cause of its "
    "waiting.",
    binding.holds);
  r("explanation", "", "A sentence with the way to the bottleneck, its numbers and advice.",
    binding.sentence());
  visit_remedy(r, binding.remedy);
}

void visit_traffic(ReportVisitor& r, const MemoryResult& m) {
  r.object("bytes_by_region", [&] {
    r.each(m.traffic, [&](const RegionTraffic& t) {
      r.object({"REGION", t.region}, [&] {
        r.object({"REQUESTER", t.requester}, [&] {
          if (r.has(t.read_bytes > 0)) {
            r("read", "B", "Bytes requested by reads; none where it is 0.", t.read_bytes);
          }
          if (r.has(t.written_bytes > 0)) {
            r("write", "B", "Bytes requested by writes; none where it is 0.", t.written_bytes);
          }
        });
      });
    });
  });
  r.object("bus_bytes_by_region", [&] {
    r.each(m.bus_bytes_by_region, [&](const auto& region_and_bytes) {
      r({"REGION", region_and_bytes.first}, "B", "Bytes on the bus for this region.",
        region_and_bytes.second);
    });
  });
}

void visit_dram(ReportVisitor& r, const MemoryResult& m) {
  r("bytes", "B", "Bytes that units requested.", m.bytes);
  r("bus_bytes", "B",
    "Bytes on the bus, in whole bursts. Fewer than requested where the write queue answers reads.",
    m.bus_bytes);
  visit_traffic(r, m);
  r("transactions", "", "TLM-2.0 transactions of the units.", m.transactions);
  r("row_hits", "bursts", "Bursts that found their row open.", m.row_hits);
  r("row_misses", "bursts", "Bursts that found their bank closed.", m.row_misses);
  r("row_conflicts", "bursts", "Bursts that found another row open.", m.row_conflicts);
  r("refreshes", "commands", "Refresh commands, of all banks or of one.", m.refreshes);
  r("bandwidth_gb_s", "10^9 B/s", "`dram.bytes` over the frame time.", m.bandwidth_gb_s);
  r("busy_bandwidth_gb_s", "10^9 B/s",
    "`dram.bytes` over the time in which the controller has a request.", m.busy_bandwidth_gb_s);
  r("peak_gb_s", "10^9 B/s", "Width times data rate of all channels.", m.peak_gb_s);
  r("of_peak", "0..1", "`dram.bandwidth_gb_s` over `dram.peak_gb_s`.",
    m.bandwidth_gb_s / m.peak_gb_s);
  r("read_latency_mean_ns", "ns",
    "Mean time of a read, from its arrival at the controller to its last datum.",
    m.read_latency_mean_ns);
  r("read_latency_p50_ns", "ns", "Median of the same time.", m.read_latency_p50_ns);
  r("read_latency_p99_ns", "ns", "Time that 99 of 100 reads do not exceed.", m.read_latency_p99_ns);
}

void visit_band(ReportVisitor& r, const Key& key, const char* unit, const Band& amount) {
  r.object(key, [&] {
    r("low", unit, "The same as the lowest values of the technology table give it.", amount.low);
    r("middle", unit, "The same as the middle values give it.", amount.middle);
    r("high", unit, "The same as the highest values give it.", amount.high);
  });
}

// Middle values, and beside them what the sources allow.
void visit_costs(ReportVisitor& r, const CostResult& cost, const std::string& suffix,
                 const char* unit, const char* of_component, const char* of_total) {
  const Key total(("total" + suffix).c_str());
  const auto key_of = [&](const std::string& component) {
    return Key("COMPONENT" + suffix, component + suffix);
  };
  r.each(cost.by_component,
         [&](const auto& part) { r(key_of(part.first), unit, of_component, part.second.middle); });
  r(total, unit, of_total, cost.total.middle);
  r.object("bands", [&] {
    r.each(cost.by_component,
           [&](const auto& part) { visit_band(r, key_of(part.first), unit, part.second); });
    visit_band(r, total, unit, cost.total);
  });
}

void visit_energy(ReportVisitor& r, const ViewResult& view) {
  visit_costs(r, view.energy_j, "_j", "J",
              "Middle energy of a component: logic, a use of on-chip memory, clock, leakage, DRAM.",
              "Middle energy of the frame.");
  r("mean_power_w", "W", "`energy.total_j` over the frame time.", view.mean_power_w());
  r.object("dram_by_current_set_j", [&] {
    r.each(view.run.memory.energy_by_current_set_j, [&](const auto& set) {
      r({"SET", set.first}, "J", "Energy of the memory by this published set of currents.",
        set.second);
    });
  });
  r.object("dram_by_region_j", [&] {
    r.each(view.run.memory.energy_by_region_j, [&](const auto& region) {
      r({"REGION", region.first}, "J",
        "Energy of the memory for this region. `standby_and_refresh` belongs to none.",
        region.second);
    });
  });
}

void visit_sram(ReportVisitor& r, const MachineResult& machine, const SramModel& model) {
  r.each(machine.sram_available, [&](const auto& memory_and_bytes) {
    const auto& [memory, available] = memory_and_bytes;
    r({"MEMORY_bytes", memory + "_bytes"}, "B", "Bytes that this on-chip memory needs.",
      sram_bytes(machine.sram_uses, memory));
    r({"MEMORY_available_bytes", memory + "_available_bytes"}, "B",
      "Bytes that the configuration gives it.", available);
  });
  r.list("uses", machine.sram_uses, [&](const SramUse& use) {
    r("name", "", "Name of this use of on-chip memory.", use.name);
    r("memory", "", "Which memory it takes its bytes from.", use.memory);
    r("bytes", "B", "Bytes of all of its memories.", use.total_bytes());
    r("built_as", "", "`sram`, or `registers`, which are in no sum of bytes.",
      use.in_registers() ? "registers" : "sram");
    r("arithmetic", "", "The product that the bytes come from.", use.product());
    r("memories", "", "Banks of this use.", use.count * use.shape.banks);
    r("width_bits", "bit", "Width of an access.", use.shape.width_bits);
    r("mm2", "mm2", "Middle area of this use.", [&] { return model.mm2(use).middle; });
    r.each(machine.sram_accesses, [&](const SramAccesses& a) {
      if (!r.has(a.use == use.name)) return;
      r("reads", "accesses", "Reads in this frame.", a.reads);
      r("writes", "accesses", "Writes in this frame.", a.writes);
      r("energy_j", "J", "Middle energy of these accesses.",
        [&] { return access_energy_j(machine, use, model).middle; });
    });
  });
}

void visit_datapath(ReportVisitor& r, const DatapathResult& result) {
  const Datapath& d = result.datapath;
  const auto cost = [&](const char* key, const char* macs_meaning, std::uint32_t macs) {
    r.object(key, [&] {
      r("macs", "", macs_meaning, macs);
      r("interval_cycles", "cycles", "Cycles that these take on the lanes of one copy.",
        (macs + d.lanes - 1) / d.lanes);
    });
  };
  r("lane", "", "Kind of its lanes: a row of the technology table.", d.lane);
  r("lanes", "", "Lanes of all copies.", d.all_lanes());
  r("items", "", "Items that passed them in this frame.", result.items);
  r.object("counts", [&] {
    r.each(d.counts, [&](const auto& count) {
      r({"CLASS", count.first}, "", "Operations of this class that one item takes.", count.second);
    });
  });
  cost("counted", "Multiply-accumulates of an item, counted by running its code.", d.counted_macs);
  if (r.has(d.published_macs > 0)) {
    cost("paper", "Multiply-accumulates of an item that the paper states.", d.published_macs);
  }
  cost("used", "Multiply-accumulates of an item that this run charges.", d.used_macs);
  const auto beside = [&](const std::string& kind, std::uint32_t operations, const auto& parts) {
    r.object("beside", [&] {
      r.object({"KIND", kind}, [&] {
        r("operations", "", "Operations of an item that parts of this kind do beside the lanes.",
          operations);
        r("parts", "", "Parts of this kind in all copies.", parts);
      });
    });
  };
  r.each(d.beside, [&](const BesideLanes& part) {
    beside(part.kind, part.operations, [&] { return d.parts(part); });
  });
  const auto between = [&](const char* kind, std::uint32_t bits, std::uint32_t of_item) {
    if (bits > 0) beside(kind, of_item, [&] { return std::uint64_t{d.copies} * bits; });
  };
  between("register_bit", d.between.registers, d.between.written);
  between("select_bit", d.between.multiplexers, d.between.selected);
  r("depth_cycles", "cycles", "Latency of an item by the schedule of its steps on these lanes.",
    d.depth_cycles);
}

void visit_ledger(ReportVisitor& r, const FrameResult& run) {
  r.list("lines", ledger_of(run.machine), [&](const LedgerLine& line) {
    r("what", "", "A component's parts, a datapath's busiest unit or a memory's accesses.",
      line.what);
    r("done", "", "Operations or accesses that it did.", line.done);
    r("per_cycle", "1/cycle", "Operations or accesses that it could do in a cycle.",
      line.per_cycle);
    r("utilisation", "0..1", "What it did over what it could do in the frame.",
      line.utilisation(run.cycles));
  });
  r("faults", "", "Work that nothing does or pays for, in words: an empty list.",
    ledger_faults(run.machine, run.cycles));
}

void visit_left_out(ReportVisitor& r, const std::vector<LeftOut>& left_out) {
  r.list("left_out", left_out, [&](const LeftOut& entry) {
    r("what", "", "What the frame did not need and did not pay, or could do without.", entry.what);
    r("why", "", "Why it was not needed.", entry.why);
    r("count", "", "How much of it.", entry.count);
    r("saves", "", "What that saves.", entry.saves);
  });
}

}  // namespace

void visit_view(ReportVisitor& r, const ViewResult& view, const PreparedScene& scene) {
  const FrameResult& run = view.run;
  r("schema_version", "", "Version of this layout.", kReportVersion);
  r.object("scene", [&] { visit_scene(r, scene); });
  r("view", "", "Number of the camera: its place among the cameras, from 0.", view.view);
  r.object("camera", [&] { visit_camera(r, view.camera); });
  r.object("image", [&] { visit_image(r, view, scene.stored.original_known()); });
  r.object("frame", [&] {
    r("cycles", "cycles", "Cycles from time 0 until the last pixel is in DRAM.", run.cycles);
    r("time_s", "s", "These cycles at the configured clock.", run.time_s());
    r("fps", "1/s", "Frames a second: 1 over the frame time.", 1 / run.time_s());
    r("width_px", "px", "Width of the picture: the camera's, or `--size`.", view.camera.width);
    r("height_px", "px", "Height of the picture.", view.camera.height);
    r("drained", "bool", "No FIFO, port or queue holds anything at the end.", run.drained);
  });
  r.object("units", [&] {
    r.each(run.machine.units, [&](const UnitResult& unit) {
      r.object({"PATH", unit.name}, [&] { visit_unit(r, unit); });
    });
  });
  r.object("binding", [&] { visit_binding(r, view.binding); });
  r.object("dram", [&] { visit_dram(r, run.memory); });
  r.object("energy", [&] { visit_energy(r, view); });
  r.object("area_mm2", [&] {
    visit_costs(r, view.area_mm2, "", "mm2",
                "Middle area of a component; `sram` is all on-chip memory.",
                "Middle area of the machine.");
    visit_band(r, "without_memory_interface", "mm2", view.area_totals_mm2.without_memory_interface);
    visit_band(r, "with_memory_interface", "mm2", view.area_totals_mm2.with_memory_interface);
    r.object("by_owner", [&] {
      r.each(view.area_by_owner_mm2.by_component, [&](const auto& part) {
        r({"OWNER", part.first}, "mm2",
          "Middle area of a kind of unit with its on-chip memory, or of what no unit owns. They "
          "add up to `area_mm2.with_memory_interface`.",
          part.second.middle);
      });
    });
  });
  r.object("sram", [&] { visit_sram(r, run.machine, view.sram_model); });
  r.object("datapath", [&] {
    r.each(run.machine.datapaths, [&](const DatapathResult& datapath) {
      r.object({"DATAPATH", datapath.datapath.name}, [&] { visit_datapath(r, datapath); });
    });
  });
  r.object("ledger", [&] { visit_ledger(r, run); });
  r.object("limit", [&] {
    r("contributing_gaussians", "", "Gaussians that are blended into a pixel or more.",
      view.golden.contributing);
    r("bytes_read_once", "B", "Both halves of each of these once, and the frame.", view.once_bytes);
    r("ratio", "ratio", "`dram.bytes` over `limit.bytes_read_once`.", view.once_ratio());
  });
  visit_left_out(r, view.left_out);
  r.object("host", [&] {
    r("simulation_wall_s", "s", "Host time of elaboration, loading and simulation of this view.",
      run.wall_s);
  });
}

}  // namespace sgs
