// simulate --estimate: what the streaming renderer's counts come to, against the simulation of the
// same frame.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// The first view of both.
struct Both {
  Json simulated, estimated;
  explicit Both(const Arguments& arguments) {
    const ScratchFolder out;
    for (const bool estimate : {false, true}) {
      const std::string folder = out.path(estimate ? "estimated" : "simulated");
      Arguments all = joined(arguments, {"--out", folder});
      if (estimate) all.push_back("--estimate");
      const Outcome outcome = run_streaminggs(joined({"simulate"}, all));
      INFO(outcome.out << outcome.err);
      REQUIRE(outcome.status == 0);
      (estimate ? estimated : simulated) = views_of_report(folder + "/report.json").front();
      CHECK((outcome.out.find("fidelity: estimate") != std::string::npos) == estimate);
    }
  }
  double error(const char* section, const char* key) const {
    const double wanted = simulated[section][key], got = estimated[section][key];
    return std::abs(got / wanted - 1);
  }
};

const Arguments kObject = {"builtin:object?n=4000", "--size", "200x160"};
const Arguments kOutdoor = {"builtin:outdoor?n=6000", "--size", "200x120"};

// Of paper order with raw second halves, with memories as large as must be.
Arguments paper(Arguments keys) {
  keys.insert(keys.end(), {"sram.shared_bytes=0", "sram.input_bytes=0"});
  return joined({"--config", "paper_no_vq"}, settings(keys));
}

// What counts events: not how long something waited, how many were there at most, or which of two
// came first; nor, where splats find their sub-tiles finished, how many still came through.
void check_counters(const Both& frame) {
  const std::set<std::string> of_time = {"subtile_blends", "subtile_blends_late", "hazard_cycles",
                                         "queue_cycles", "chunk_queue_max", "node_queue_max",
                                         // which of two passes of rays came first
                                         "node_cache_misses",
                                         // when a part without pixels was known to be finished
                                         "coarse_tests_of_parts"};
  const std::set<std::string> of_hidden = {"splats",       "rows",           "spans",
                                           "splats_taken", "splats_spanned", "splats_hidden"};
  const Json& units = frame.simulated["units"];
  const bool hidden = std::any_of(units.begin(), units.end(), [](const Json& unit) {
    return unit["counters"].value("splats_hidden", 0) != 0;
  });
  for (const auto& [unit, simulated] : units.items()) {
    const auto& estimated = frame.estimated["units"].at(unit).at("counters");
    for (const auto& [name, count] : simulated["counters"].items()) {
      if (of_time.count(name) != 0 || (hidden && of_hidden.count(name) != 0)) continue;
      INFO(unit << ' ' << name);
      CHECK(estimated.value(name, Json()) == count);
    }
  }
}

// Cycles of work. Where an item has its own cycles whenever it comes, they are equal: a cycle for a
// slice or a second half that is asked for, and for a visit that is given on; lists that are sorted
// have their lengths, the pixels their number. Others hold their lanes while they wait for room,
// and share a beginning with what came just before; how much, depends on when it came.
void check_work(const Both& frame) {
  const std::set<std::string> equal = {"load", "fetch", "hand_out", "emit", "sort", "drain"};
  const std::set<std::string> of_rays_and_nodes = {"walk", "test", "traverse"};
  for (const auto& [unit, simulated] : frame.simulated["units"].items()) {
    for (const auto& [activity, of] : simulated["activities"].items()) {
      INFO(unit << ' ' << activity);
      const std::string kind = activity.substr(0, activity.find_last_not_of("0123456789") + 1);
      const std::uint64_t wanted = of["busy_cycles"], got = cycles(frame.estimated, unit, activity);
      CHECK(wanted > 0);
      if (equal.count(kind) != 0) {
        CHECK(got == wanted);
      } else {
        const double near = of_rays_and_nodes.count(kind) != 0 ? 0.02 : 0.12;
        CHECK(static_cast<double>(got) == Approx(static_cast<double>(wanted)).epsilon(near));
      }
    }
  }
}

TEST_CASE("estimate: bytes are the simulation's where nothing depends on when it happens") {
  for (const Arguments& scene : {kObject, kOutdoor}) {
    INFO(scene[0]);
    const Both frame(with_settings(
        scene, {"rendering.saturation_feedback=false", "merge.entries=4096", "sram.shared_bytes=0",
                "vsu.queue_entries=4096", "vsu.node_queue_entries=4096", "group_width_px=64",
                "group_height_px=48"}));
    CHECK(frame.estimated["dram"]["bytes_by_region"] == frame.simulated["dram"]["bytes_by_region"]);
    CHECK(frame.estimated["dram"]["transactions"] == frame.simulated["dram"]["transactions"]);
    for (const char* path : {"chunk_test", "coarse", "fine"}) {
      CHECK(frame.estimated["datapath"][path] == frame.simulated["datapath"][path]);
    }
    check_counters(frame);
    check_work(frame);
  }
}

TEST_CASE("estimate: bytes of paper order are the simulation's where nothing is finished early") {
  for (const Arguments& scene : {kObject, kOutdoor}) {
    for (const char* fetch : {"fetch=split", "fetch=shared"}) {
      INFO(scene[0] << " " << fetch);
      const Both frame(joined(with_settings(scene, {"rendering.saturation_feedback=false", fetch,
                                                    "sram.shared_bytes=0", "sram.input_bytes=0"}),
                              {"--config", "paper_no_vq"}));
      // Which of the lines of two passes of rays comes first is a matter of time.
      for (const char* region : {"first_halves", "second_halves", "frame_buffer"}) {
        INFO(region);
        CHECK(frame.estimated["dram"]["bytes_by_region"][region] ==
              frame.simulated["dram"]["bytes_by_region"][region]);
      }
      for (const char* path : {"pixel_ray", "ray_step", "coarse", "fine"}) {
        INFO(path);
        CHECK(frame.estimated["datapath"][path] == frame.simulated["datapath"][path]);
      }
      check_counters(frame);
      check_work(frame);
    }
  }
}

TEST_CASE("estimate: what lists spill is what the simulation's spill, pass by pass") {
  const Both frame(joined(with_settings(kOutdoor, {"rendering.saturation_feedback=false",
                                                   "sram.shared_bytes=0", "sram.input_bytes=0",
                                                   "vsu.visit_gaussians=0", "storage.voxel_size=8",
                                                   "sorting.buffer_entries=16", "sorting_units=1"}),
                          {"--config", "paper_no_vq"}));
  // More than one entry for each splat: runs of runs.
  CHECK(total(frame.simulated, "entries_spilled") > counter(frame.simulated, "sorting0", "splats"));
  CHECK(frame.estimated["dram"]["bytes_by_region"]["spill"] ==
        frame.simulated["dram"]["bytes_by_region"]["spill"]);
  check_counters(frame);
  check_work(frame);
}

TEST_CASE("estimate: codebooks are read as in the simulation, but for busy banks") {
  for (const char* preset : {"exact_vq", "paper"}) {
    INFO(preset);
    const Both frame(joined(
        with_settings(kObject, {"rendering.saturation_feedback=false", "storage.vq.iterations=2",
                                "sram.shared_bytes=0", "sram.input_bytes=0"}),
        {"--config", preset}));
    const auto both = [&](const char* name, double simulated, double estimated, double near) {
      INFO(name);
      CHECK(simulated > 0);
      CHECK(estimated == Approx(simulated).epsilon(near));
    };
    for (const char* name :
         {"records_decoded", "bytes_loaded", "second_halves_taken", "fine_tests"}) {
      CAPTURE(name);
      CHECK(total(frame.simulated, name) > 0);
      CHECK(total(frame.estimated, name) == total(frame.simulated, name));
    }
    // The estimate takes the mean record's lines for each.
    const auto lines = [](const Json& view) {
      return static_cast<double>(total(view, "lines_read"));
    };
    both("lines", lines(frame.simulated), lines(frame.estimated), 0.01);
    const auto conflicts = static_cast<double>(total(frame.simulated, "bank_conflict_cycles"));
    const auto decode = [](const Json& view) {
      return static_cast<double>(total_busy(view, "decode"));
    };
    // Filling the buffer is waiting for memory.
    CHECK(cycles(frame.simulated, "codebooks", "load") == 0);
    CHECK(cycles(frame.estimated, "codebooks", "load") == 0);
    both("decode", decode(frame.simulated) - conflicts, decode(frame.estimated), 0.01);
  }
}

TEST_CASE("estimate: queues hold at most their entries") {
  const Both frame(with_settings(kObject, {"storage.chunk_gaussians=1", "vsu.node_queue_entries=10",
                                           "vsu.queue_entries=12", "sram.shared_bytes=0"}));
  CHECK(counter(frame.simulated, "vsu", "queue_entries_put_aside") > 0);
  for (const Json* view : {&frame.simulated, &frame.estimated}) {
    CHECK(counter(*view, "vsu", "node_queue_max") == 10);
    CHECK(counter(*view, "vsu", "chunk_queue_max") == 12);
  }
}

TEST_CASE("estimate: what finds its part of a group finished is counted as in the simulation") {
  const Both frame(
      joined(kOutdoor, paper({"fetch=shared", "group_width_px=16", "group_height_px=16"})));
  const auto of = [](const Json& view, const char* name) {
    return static_cast<double>(counter(view, "hfu0.fine", name));
  };
  for (const Json* view : {&frame.simulated, &frame.estimated}) {
    const double fetched = of(*view, "dropped_fetched");
    CHECK(fetched <= of(*view, "dropped_saturated"));
    // Some before their second half came for other parts, some behind that.
    CHECK(of(*view, "second_halves_taken") > of(*view, "fine_tests"));
    CHECK(fetched > of(*view, "second_halves_taken") - of(*view, "fine_tests"));
    const std::uint64_t late = counter_of_all(*view, "sorting", "splats_saturated");
    CHECK(late > 0);
    std::uint64_t blended = 0;
    for (const char* name : {"splats_taken", "splats_hidden", "splats_saturated"}) {
      blended += counter_of_all(*view, "rendering", name);
    }
    CHECK(counter_of_all(*view, "sorting", "splats") - late == blended);
  }
  for (const char* name : {"dropped_saturated", "dropped_fetched"}) {
    INFO(name);
    CHECK(of(frame.estimated, name) == Approx(of(frame.simulated, name)).epsilon(0.2));
  }
}

// What holds of any estimate: nothing unpaid, and no less time than one resource takes.
void check_bounds(const Both& frame) {
  const Json& view = frame.estimated;
  CHECK(view["area_mm2"] == frame.simulated["area_mm2"]);
  CHECK(view["ledger"]["faults"].empty());
  const double cycles = view["frame"]["cycles"], seconds = view["frame"]["time_s"];
  for (const Json& line : view["ledger"]["lines"]) {
    INFO(line);
    CHECK(line["utilisation"].get<double>() <= 1);
  }
  for (const auto& [name, unit] : view["units"].items()) {
    for (const auto& [activity, of] : unit["activities"].items()) {
      INFO(name << "." << activity);
      CHECK(of["busy_cycles"].get<double>() <= cycles);
    }
  }
  const double bus_gb = view["dram"]["bus_bytes"].get<double>() / 1e9;
  CHECK(bus_gb / view["dram"]["peak_gb_s"].get<double>() <= seconds);
}

TEST_CASE("estimate: never below what one resource takes, small frames") {
  const Arguments one_group = {"merge.entries=16", "group_width_px=64", "group_height_px=64",
                               "sram.shared_bytes=0", "sram.input_bytes=0"};
  const std::vector<Arguments> machines = {
      settings(one_group),
      settings(joined(one_group, {"merge.on_overflow=blend_early"})),
      settings({"rendering.precision=fixed16", "storage.chunk_gaussians=1", "vsu.upper_nodes=0",
                "sram.shared_bytes=0"}),
      {"--config", "exact_fp16"},
      joined({"--config", "paper_no_cgf"},
             settings({"vsu.table_bytes=64", "storage.vq.iterations=1", "sram.shared_bytes=0"}))};
  for (const Arguments& machine : machines) {
    INFO(machine.back());
    const Both frame(joined({"builtin:object?n=400", "--size", "64x64"}, machine));
    check_bounds(frame);
    CHECK(frame.error("dram", "bytes") < 0.05);
  }
}

TEST_CASE("estimate: close to the simulation, and never below what one resource takes", "[long]") {
  struct Case {
    Arguments scene, options;
  };
  const Arguments kObjectAtoms = {"builtin:object?n=1500", "--size", "64x64"};
  const Arguments of_atoms = {"group_width_px=16",         "group_height_px=16",
                              "storage.chunk_gaussians=1", "vsu.upper_nodes=0",
                              "vsu.nodes_in_flight=4",     "sram.shared_bytes=0"};
  const std::vector<Case> cases = {
      {kObject, {}},
      {kOutdoor, {}},
      {kOutdoor, {"--config", "exact_half"}},
      {kObject, {"--config", "exact_fp16"}},
      {kOutdoor, settings({"rendering.precision=fixed16", "sram.shared_bytes=0"})},
      {kOutdoor, {"--config", "exact_vq"}},
      {kObject, settings({"merge.entries=64", "group_width_px=160", "group_height_px=160",
                          "sram.shared_bytes=0"})},
      {kOutdoor, settings({"merge.entries=48", "merge.on_overflow=blend_early"})},
      {kOutdoor, settings({"hfus=1", "sorting_units=2", "dram.channels=1"})},
      {kObject,
       settings({"hfus=8", "rendering.clusters=1", "sram.shared_bytes=0", "sram.input_bytes=0"})},
      // Walks over nodes of few children, which wait for the memory, and for room before the nodes.
      {kObjectAtoms, settings(of_atoms)},
      {kObjectAtoms, settings(joined(of_atoms, {"vsu.node_queue_entries=4096"}))},
      {kObjectAtoms, settings(joined(of_atoms, {"vsu.node_queue_entries=64"}))},
      {kObject, {"--config", "paper"}},
      {kOutdoor, {"--config", "paper_no_cgf"}},
      {kOutdoor, {"--config", "paper_no_vq_cgf"}},
      {kObject, paper({"fetch=shared"})},
      // A table that is too small, lists that spill and are merged in two passes, few slots.
      {kOutdoor, paper({"vsu.table_bytes=512", "vsu.groups_ahead=2"})},
      {kOutdoor, paper({"vsu.visit_gaussians=0", "storage.voxel_size=8",
                        "sorting.buffer_entries=16", "sorting_units=1"})},
      {kObject, paper({"hfu.second_half_slots=2", "hfus=2", "dram.channels=1"})}};
  for (const Case& c : cases) {
    std::string words = c.scene[0];
    for (const std::string& option : c.options) words += " " + option;
    INFO(words);
    const Both frame(joined(c.scene, c.options));
    // What README.md states for these.
    CHECK(frame.error("frame", "cycles") < 0.12);
    CHECK(frame.error("dram", "bytes") < 0.03);
    CHECK(frame.error("energy", "total_j") < 0.05);
    check_bounds(frame);
  }
}

TEST_CASE("estimate: says so, and that its picture is the streaming renderer's") {
  const Both frame(kObject);
  CHECK(frame.simulated["fidelity"] == "accurate");
  CHECK(frame.estimated["fidelity"] == "estimate");
  CHECK(frame.simulated["image"]["frame_from"] == "dram");
  CHECK(frame.estimated["image"]["frame_from"] == "streaming_renderer");
  CHECK(frame.estimated["image"]["equals_streaming_renderer"].is_null());
  for (const char* key : {"psnr_db", "ssim", "max_abs_error", "blends"}) {
    CHECK(frame.estimated["image"][key] == frame.simulated["image"][key]);
  }
}

}  // namespace
}  // namespace sgs::test
