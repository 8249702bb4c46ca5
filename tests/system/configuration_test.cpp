// Configurations that say next to nothing, and runs of which one view fails.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/cameras.h"
#include "algorithm/scene/ply_writer.h"
#include "testbench/builtin/open_scene.h"
#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
using Json = nlohmann::json;

TEST_CASE("configuration: what a file leaves out has defaults that fit each other") {
  for (const char* text : {"{}", R"({"hfus": 4})", R"({"machine": "exact"})",
                           R"({"machine": "paper"})", R"({"machine": "paper", "hfus": 4})"}) {
    INFO(text);
    const ScratchFolder scratch;
    const Simulation simulation({"builtin:object?n=1000", "--size", "64x36", "--config",
                                 scratch.write("config.json", text)});
    simulation.check();
    const std::string machine = simulation.views()[0]["config"]["machine"];
    const bool paper = std::string(text).find("paper") != std::string::npos;
    CHECK(machine == (paper ? "paper" : "exact"));
    CHECK(simulation.views()[0]["config"]["hfus"] == 4);
  }
}

TEST_CASE("configuration: what is printed and read again is the same machine, and as open") {
  const Arguments scene = {"builtin:object?n=3000", "--size", "96x54"};
  for (const auto& [preset, open] : std::vector<std::pair<std::string, const char*>>{
           {"exact", "/vsu/test_depth_cycles"}, {"paper_no_vq", "/storage/voxel_size"}}) {
    INFO(preset);
    const auto print = [&](const std::string& config) {
      const Outcome shown = run_streaminggs(
          joined({"simulate"}, joined(scene, {"--config", config, "--print-config"})));
      REQUIRE(shown.status == 0);
      return shown.out;
    };
    const std::string printed = print(preset);
    const Json keys = Json::parse(printed);
    for (const char* key :
         {"/hfu/cfu_macs", "/hfu/ffu_macs", "/hfu/cfu_depth_cycles", "/hfu/ffu_depth_cycles",
          "/rendering/depth_cycles", "/rendering/state_loop_cycles", open}) {
      INFO(key);
      CHECK(keys[Json::json_pointer(key)] == 0);
    }
    const ScratchFolder scratch;
    const std::string file = scratch.write("mine.json", printed);
    CHECK(print(file) == printed);
    std::vector<std::uint64_t> cycles;
    for (const char* set : {"lane_latency_cycles=3", "lane_latency_cycles=8"}) {
      INFO(set);
      const auto run = [&](const std::string& config) {
        return Simulation(with_settings(joined(scene, {"--config", config}), {set})).views()[0];
      };
      const Json of_preset = run(preset), of_printed = run(file);
      for (const char* same : {"frame", "config", "chosen", "area_mm2"}) {
        INFO(same);
        CHECK(of_printed[same] == of_preset[same]);
      }
      cycles.push_back(of_printed["frame"]["cycles"]);
    }
    CHECK(cycles[0] < cycles[1]);
  }
}

TEST_CASE("configuration: a machine's name alone is the preset of its name, or as little away") {
  const ScratchFolder scratch;
  for (const auto& [machine, differs] : std::vector<std::pair<std::string, const char*>>{
           {"exact", ""},
           {"paper", R"(, "rendering": {"cluster_lanes": 182}, "storage": {"encoding": "vq"})"}}) {
    const auto print = [&](const std::string& config) {
      return run_streaminggs(
                 {"simulate", "builtin:object?n=500", "--config", config, "--print-config"})
          .out;
    };
    const std::string text = R"({"machine": ")" + machine + R"(")" + differs + "}";
    INFO(text);
    const std::string of_preset = print(machine);
    CHECK_FALSE(of_preset.empty());
    CHECK(print(scratch.write("config.json", text)) == of_preset);
  }
}

// What the numbers of the machines may be. e, p, g: the exact, paper and tile-centric machines'
// keys.
struct Limits {
  const char *machines, *low, *high;
  std::vector<std::string> keys;
};
const std::vector<Limits>& limits() {
  static const std::vector<Limits> kLimits = {
      {"epg", "0", "1", {"storage.sh_tolerance"}},
      {"epg", "0", "8", {"dram.refresh_postpone_max"}},
      {"epg", "0", "64", {"memory_port.path_cycles"}},
      {"epg", "0", "100", {"dram.io_pj_per_bit"}},
      {"epg", "0", "1000", {"storage.vq.iterations", "dram.front_end_ns", "dram.back_end_ns"}},
      {"epg", "0", "1023", {"dram.write_low_watermark"}},
      {"epg", "0", "100000000", {"dram.power_down_idle_cycles", "dram.self_refresh_idle_cycles"}},
      {"epg", "0", "9223372036854775807", {"storage.vq.seed"}},
      {"epg", "1", "2", {"rendering.pixel_buffers"}},
      {"epg", "1", "4", {"dram.ranks"}},
      {"epg", "1", "16", {"dram.channels"}},
      {"epg", "1", "64", {"lane_latency_cycles", "half_lane_latency_cycles"}},
      {"epg", "1", "1000", {"rendering.feedback_latency_cycles"}},
      {"epg",
       "1",
       "1024",
       {"dram.read_queue_entries", "dram.write_queue_entries", "dram.write_high_watermark"}},
      {"epg", "1", "4096", {"memory_port.max_outstanding", "memory_port.max_writes"}},
      {"epg", "1", "10000", {"clock_mhz"}},
      {"epg",
       "1",
       "65536",
       {"storage.vq.scale_entries", "storage.vq.rotation_entries", "storage.vq.dc_entries",
        "storage.vq.sh_entries"}},
      {"epg", "1", "1000000", {"dram.age_cap_cycles"}},
      {"epg", "32", "4096", {"memory_port.max_transaction_bytes"}},
      {"ep",
       "0",
       "1000",
       {"rendering.state_loop_cycles", "rendering.depth_cycles", "rendering.begin_depth_cycles",
        "rendering.span_depth_cycles", "rendering.drain_depth_cycles"}},
      {"ep", "0", "1020", {"group_width_px", "group_height_px"}},
      {"ep",
       "0",
       "10000",
       {"hfu.cfu_macs", "hfu.cfu_depth_cycles", "hfu.ffu_macs", "hfu.ffu_depth_cycles"}},
      {"ep", "0", "1073741824", {"sram.input_bytes", "sram.codebook_bytes", "sram.shared_bytes"}},
      {"ep", "1", "16", {"sorting_units"}},
      {"ep",
       "1",
       "64",
       {"hfus", "sorting.sort_interval_cycles", "sorting.merge_interval_cycles", "hfu.cfus",
        "codebook.banks"}},
      {"ep", "1", "100", {"codebook.latency_cycles"}},
      {"ep", "1", "256", {"rendering.clusters"}},
      {"ep", "1", "1000", {"sorting.sort_latency_cycles"}},
      {"ep",
       "1",
       "1024",
       {"hfu.second_half_slots", "rendering.cluster_queue_entries", "rendering.span_slots"}},
      {"ep",
       "1",
       "4096",
       {"hfu.candidate_fifo_entries", "rendering.cluster_lanes", "rendering.begin_lanes",
        "rendering.span_lanes", "rendering.input_fifo_entries",
        "rendering.drain_pixels_per_cycle"}},
      {"ep", "1", "10000", {"hfu.cfu_lanes", "hfu.ffu_lanes"}},
      {"ep", "2", "1024", {"hfu.input_slots"}},
      {"ep", "2", "1048576", {"hfu.slice_gaussians"}},
      {"ep", "4", "256", {"codebook.line_bytes"}},
      {"e", "0", "10000", {"vsu.test_depth_cycles"}},
      {"e", "0", "65535", {"storage.chunk_gaussians"}},
      {"e", "0", "1048576", {"vsu.upper_nodes"}},
      {"e", "1", "1000", {"merge.latency_cycles"}},
      {"e", "1", "1024", {"vsu.nodes_in_flight", "vsu.nodes_in_test", "merge.spill_block_entries"}},
      {"e", "1", "4096", {"merge.input_fifo_entries", "merge.output_fifo_entries"}},
      {"e", "1", "10000", {"vsu.test_lanes"}},
      {"e", "2", "16", {"merge.cycles_per_operation"}},
      {"e", "2", "64", {"vsu.cycles_per_queue_operation"}},
      {"e", "2", "1024", {"merge.spill_runs"}},
      {"e", "2", "16777216", {"merge.entries"}},
      // The children of a node, and one that is taken.
      {"e", "9", "16777216", {"vsu.queue_entries", "vsu.node_queue_entries"}},
      {"p", "0", "10", {"vsu.sample_step_voxels"}},
      {"p",
       "0",
       "1000",
       {"vsu.step_depth_cycles", "vsu.cell_step_depth_cycles", "vsu.ray_depth_cycles"}},
      {"p", "0", "1000000000", {"storage.voxel_size"}},
      {"p", "0", "1073741824", {"vsu.visit_gaussians"}},
      {"p", "1", "64", {"vsu.table_banks", "vsu.groups_ahead"}},
      {"p",
       "1",
       "1024",
       {"vsu.rays_in_flight", "vsu.chain_entries", "vsu.ray_step_px",
        "sorting.spill_block_entries"}},
      {"p", "1", "1024", {"vsu.node_fetches"}},
      {"p", "1", "4096", {"sorting.input_fifo_entries"}},
      {"p", "1", "10000", {"vsu.step_lanes", "vsu.ray_lanes"}},
      {"p", "2", "1048576", {"vsu.min_share"}},
      {"p", "8", "1073741824", {"vsu.table_bytes"}},
      {"p", "16", "1048576", {"sorting.buffer_entries"}},
      {"p",
       "64",
       "1073741824",
       {"vsu.node_cache_bytes", "vsu.record_cache_bytes", "vsu.cut_cache_bytes"}},
      {"g", "0", "4096", {"rendering.core_lanes"}},
      {"g", "0", "65536", {"sorting.list_entries"}},
      {"g", "0", "1048576", {"lists.tiles", "lists.lines"}},
      {"g", "0", "1073741824", {"sram.buffer_bytes"}},
      {"g", "1", "4", {"tiles.subtiles_across", "rendering.drain_pixels_per_cycle"}},
      {"g", "1", "16", {"lists.tiles_at_once", "sorting.list_buffers"}},
      {"g", "1", "64", {"ccus", "cores", "ccu.input_slots", "lists.block_lines"}},
      {"g", "1", "256", {"ccu.cull_lanes", "ccu.slice_gaussians", "ccu.second_half_slots"}},
      {"g",
       "1",
       "1024",
       {"ccu.convert_lanes", "ccu.candidates", "ccu.output_entries", "lists.tile_lanes",
        "lists.part_lanes", "lists.tested_entries", "rendering.record_slots"}},
      {"g", "1", "65536", {"rendering.sorted_entries"}},
      {"g", "16", "4096", {"sorting.chunk_entries"}},
      {"g", "32", "256", {"lists.line_bytes"}},
      {"g", "4096", "1099511627776", {"lists.pool_bytes"}}};
  return kLimits;
}

// A whole number's neighbour.
std::string next_to(const std::string& number, int away) {
  return number == "9223372036854775807" ? "9223372036854775808"
                                         : std::to_string(std::stoll(number) + away);
}

// What `describe` says a machine's numbers may be: "low..high" by key.
std::map<std::string, std::string> stated_limits(const std::string& preset) {
  const std::string described = run_streaminggs({"describe", "--config", preset}).out;
  const std::regex line(R"(([a-z0-9_.]+) = \S*  \((-?[0-9.e+]+\.\.[0-9.e+]+)\)  .*)");
  std::map<std::string, std::string> stated;
  std::istringstream lines(described);
  for (std::string text; std::getline(lines, text);) {
    std::smatch parts;
    if (std::regex_match(text, parts, line)) stated[parts[1]] = parts[2];
  }
  return stated;
}

// Units that are there several times have one row for each of their activities, of all of them.
TEST_CASE(
    "configuration: what describe lists of units are those of a frame, without their numbers") {
  const std::regex number("[0-9]+"), row(R"(\| `(\S+)` \| `(\S+)` \| .*)");
  for (const char* preset : {"exact", "paper_no_vq", "gscore"}) {
    INFO(preset);
    const Simulation simulation({"builtin:object?n=50", "--size", "16x16", "--config", preset});
    std::set<std::pair<std::string, std::string>> wanted, listed;
    for (const auto& [unit, of] : simulation.views()[0]["units"].items()) {
      for (const auto& [activity, cycles] : of["activities"].items()) {
        wanted.insert({std::regex_replace(unit, number, "N"), activity});
      }
    }
    std::istringstream lines(run_streaminggs({"describe", "--config", preset}).out);
    for (std::string line; std::getline(lines, line) && line.rfind("| unit | counter |", 0) != 0;) {
      std::smatch parts;
      if (!std::regex_match(line, parts, row)) continue;
      CHECK(listed.insert({parts[1], parts[2]}).second);
    }
    CHECK(listed == wanted);
  }
}

// Each is the promise of a key to who uses it: one that changes is meant to.
TEST_CASE("configuration: what numbers may be, stated and kept to, of all keys of all machines") {
  for (const auto& [machine, preset] : std::vector<std::pair<char, std::string>>{
           {'e', "exact"}, {'p', "paper_no_vq"}, {'g', "gscore"}}) {
    INFO(preset);
    std::map<std::string, std::string> wanted;
    for (const Limits& row : limits()) {
      if (std::string(row.machines).find(machine) == std::string::npos) continue;
      for (const std::string& key : row.keys) {
        wanted[key] = std::string(row.low) + ".." + row.high;
        // Asked of one machine; the others' are the same keys.
        if (row.machines[0] != machine) continue;
        const auto set = [&, preset = preset](const std::string& value) {
          return run_streaminggs({"describe", "--config", preset, "--set", key + "=" + value});
        };
        // The last that is in it may still not fit the rest of the machine.
        for (const char* last : {row.low, row.high}) {
          const Outcome outcome = set(last);
          INFO(outcome.err);
          CHECK_THAT(outcome.err, !Contains(std::string(" [") + row.low + ", "));
          CHECK((outcome.status == 0 || outcome.status == 2));
        }
        for (const std::string& beyond : {next_to(row.low, -1), next_to(row.high, 1)}) {
          const Outcome outcome = set(beyond);
          INFO(outcome.err);
          CHECK(outcome.status == 2);
          CHECK(outcome.out.empty());
          CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
          CHECK_THAT(outcome.err, Contains(key + ": got " + beyond + ", expected a"));
          CHECK_THAT(outcome.err, Contains(std::string(" in [") + row.low + ", " + row.high + "]"));
        }
      }
    }
    CHECK(stated_limits(preset) == wanted);
  }
}

// A scene of three views, of which the second is a frame of 2.4 MB, and a memory of `rows` rows of
// 128 KiB in all channels.
struct TightMemory {
  ScratchFolder folder;
  Arguments arguments;
  explicit TightMemory(int rows) {
    Scene scene = open_scene("builtin:object?n=1000");
    scene.cameras.resize(3, scene.cameras.front());
    for (int view = 0; view < 3; ++view) {
      scene.cameras[view] = scaled_to(scene.cameras[view], 64, 36);
      scene.cameras[view].id = view;
    }
    scene.cameras[1] = scaled_to(scene.cameras[1], 1024, 768);
    write_ply(folder.path("scene.ply"), scene.cloud);
    write_cameras(folder.path("cameras.json"), scene.cameras);
    Json spec = Json::parse(bytes_of(SGS_SOURCE_DIR "/modules/dram/memspecs/lpddr3_1600_4gb.json"));
    spec["organisation"]["rows"] = rows;
    arguments = {"simulate",  folder.path("scene.ply"),
                 "--cameras", folder.path("cameras.json"),
                 "--config",  "paper_no_vq",
                 "--set",     "dram.memspec=" + folder.write("small.json", spec.dump())};
  }
};

TEST_CASE("configuration: a view that fails is named, loses no other, and ends with status 1") {
  const TightMemory tight(16);
  const ScratchFolder scratch;
  const Outcome outcome =
      run_streaminggs(joined(tight.arguments, {"--view", "all", "--out", scratch.path("out")}));
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, Contains("streaminggs: view 1: dram: the scene and its frame take"));
  const Json report = Json::parse(bytes_of(scratch.path("out/report.json")));
  REQUIRE(report["failed"].size() == 1);
  CHECK(report["failed"][0]["view"] == 1);
  REQUIRE(report["views"].size() == 2);
  CHECK(report["views"][0]["view"] == 0);
  CHECK(report["views"][1]["view"] == 2);
  for (const int view : {0, 1, 2}) {
    INFO("view " << view);
    const std::string folder = scratch.path("out/view_" + std::to_string(view));
    CHECK(std::filesystem::exists(folder) == (view != 1));
    CHECK(std::filesystem::exists(folder + "/report.json") == (view != 1));
    CHECK(std::filesystem::exists(folder + "/frame.png") == (view != 1));
  }
  for (Json view : report["views"]) {
    view["config"] = report["config"];
    check_any_machine(view);
  }
}

TEST_CASE("configuration: where every view fails nothing is written") {
  const TightMemory tight(1);
  // What no view can be drawn with is wrong with what was given, asked for alone or not: one line.
  for (const char* view : {"all", "0"}) {
    INFO(view);
    const ScratchFolder scratch;
    const Outcome outcome =
        run_streaminggs(joined(tight.arguments, {"--view", view, "--out", scratch.path("out")}));
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("dram: the scene and its frame take"));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(scratch.file_count() == 0);
  }
}

TEST_CASE("configuration: views that all finish leave nobody named as failed") {
  const ScratchFolder scratch;
  REQUIRE(run_streaminggs({"simulate", "builtin:object?n=500", "--size", "32x18", "--view", "all",
                           "--out", scratch.path("out")})
              .status == 0);
  CHECK(Json::parse(bytes_of(scratch.path("out/report.json")))["failed"].empty());
}

}  // namespace
}  // namespace sgs::test
