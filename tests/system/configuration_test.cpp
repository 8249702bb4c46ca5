// Configurations that say next to nothing, and runs of which one view fails.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/camera.h"
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
    const bool four = paper || std::string(text).find("4") != std::string::npos;
    CHECK(simulation.views()[0]["config"]["hfus"] == (four ? 4 : 2));
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

TEST_CASE("configuration: a file's values lie over those of the preset that is its base") {
  const auto printed = [](const Arguments& config) {
    const Outcome shown = run_streaminggs(
        joined({"simulate", "builtin:object?n=500", "--print-config", "--config"}, config));
    INFO(shown.err);
    REQUIRE(shown.status == 0);
    return shown.out;
  };
  const ScratchFolder scratch;
  const auto based = [&](const char* text) { return Arguments{scratch.write("mine.json", text)}; };
  CHECK(printed(based(R"({"base": "exact", "hfus": 2, "merge": {"entries": 64}})")) ==
        printed(with_settings({"exact"}, {"hfus=2", "merge.entries=64"})));
  // A preset may have a base of its own.
  CHECK(printed(based(R"({"base": "paper_no_vq_cgf", "hfu": {"coarse_filter": true}})")) ==
        printed({"paper_no_vq"}));
  for (const auto& [text, says] : {
           std::pair{R"({"base": "papre"})",
                     "mine.json: base: got papre; did you mean paper? Expected one of exact, "},
           {R"({"base": 3})", "mine.json: base: got 3, expected one of exact, "},
           {R"({"base": "exact", "machine": "paper"})",
            "preset exact: vsu.upper_nodes: unknown key"},
           {R"({"base": "exact", "hfus": 0})", "mine.json: hfus: got 0, expected"},
       }) {
    const Outcome refused =
        run_streaminggs(joined({"simulate", "builtin:object?n=500", "--config"}, based(text)));
    CHECK(refused.status == 2);
    CHECK_THAT(refused.err, Contains(says));
  }
}

TEST_CASE("configuration: fitted memories change nothing but what is left over") {
  const Arguments scene = {"builtin:object?n=500", "--size", "64x36"};
  for (const char* preset : {"exact", "paper", "gscore_lossless"}) {
    INFO(preset);
    const Arguments drawn = joined(scene, {"--config", preset});
    const Json plain = Simulation(drawn).views()[0],
               fitted = Simulation(joined(drawn, {"--fit-memories"})).views()[0];
    for (const char* same : {"frame", "image", "units", "dram", "energy", "area_mm2", "binding"}) {
      INFO(same);
      CHECK(fitted[same] == plain[same]);
    }
    for (const auto& [key, bytes] : fitted["config"]["sram"].items()) {
      if (key == "codebook_bytes") continue;
      INFO(key);
      CHECK(bytes == fitted["sram"][key]);
      CHECK(bytes <= plain["config"]["sram"][key]);
    }
  }
}

TEST_CASE(
    "configuration: memories that are fitted do not stop what grows, but decide what is open") {
  const Arguments scene = {"builtin:object?n=500", "--size", "64x36", "--fit-memories"};
  const Arguments more = with_settings(scene, {"hfus=8"});
  CHECK(Simulation(more).views()[0]["config"]["hfus"] == 8);
  CHECK(run_streaminggs({"simulate", "builtin:object?n=500", "--set", "hfus=8"}).status == 2);
  const ScratchFolder scratch;
  const std::string mine =
      scratch.write("mine.json", R"({"machine": "exact", "sram": {"shared_bytes": 400000}})");
  for (const char* command : {"simulate", "what-if"}) {
    const std::string out = scratch.path(std::string(command) + ".json");
    const Arguments words = joined({command}, joined(scene, {"--config", mine, "--out", out}));
    CHECK_THAT(run_streaminggs(words).out,
               Contains("memories are fitted, not as given: sram.shared_bytes 400000 (" + mine));
  }
  struct Refusal {
    const char *preset, *set, *says;
  };
  for (const Refusal& of : {
           Refusal{"exact", "sram.shared_bytes=900000",
                   "--set sram.shared_bytes=900000: got it with --fit-memories"},
           Refusal{"gscore", "sram.buffer_bytes=9",
                   "--set sram.buffer_bytes=9: got it with --fit-memories"},
           Refusal{"gscore", "cores=64",
                   "bytes are there to decide the lists by, expected at least"},
       }) {
    INFO(of.set);
    const Outcome refused = run_streaminggs(
        with_settings(joined({"simulate"}, joined(scene, {"--config", of.preset})), {of.set}));
    CHECK(refused.status == 2);
    CHECK_THAT(refused.err, Contains(of.says));
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  }
}

TEST_CASE("configuration: what is printed of fitted memories is what they decided") {
  const ScratchFolder scratch;
  const Arguments scene = {"builtin:object?n=500", "--size", "64x36", "--fit-memories"};
  const auto print = [&](const std::string& config) {
    const Arguments words = joined(scene, {"--config", config, "--print-config"});
    return run_streaminggs(with_settings(joined({"simulate"}, words), {"framebuffer=rgb32f"})).out;
  };
  const std::string printed = print("gscore_lossless");
  const Json keys = Json::parse(printed);
  const Json run = Simulation(joined(scene, {"--config", "gscore_lossless"})).views()[0]["config"];
  for (const char* key : {"/lists/tiles", "/lists/lines", "/sorting/list_entries"}) {
    INFO(key);
    CHECK(keys[Json::json_pointer(key)] > 0);
    CHECK(keys[Json::json_pointer(key)] == run[Json::json_pointer(key)]);
  }
  CHECK(print(scratch.write("mine.json", printed)) == printed);
}

TEST_CASE("configuration: simulate notes what tb_dram notes of the memory, and charges its I/O") {
  const ScratchFolder scratch;
  Json memspec = Json::parse(run_streaminggs({"describe", "--memspec", "lpddr3_1600_4gb"}).out,
                             nullptr, true, true);
  memspec["io_pj_per_bit"] = 7;
  memspec["timing_cycles"]["refi_bank"] = 389;
  const std::string file = scratch.write("mine.json", memspec.dump());
  const Outcome done = run_streaminggs(with_settings(
      {"simulate", "builtin:object?n=50", "--size", "32x18", "--out", scratch.path("")},
      {"dram.memspec=" + file}));
  REQUIRE(done.status == 0);
  CHECK(done.err.find("note: lpddr3_1600_4gb: refi is 3120 but refi_bank x banks is 3112\n") !=
        std::string::npos);
  const Json report = Json::parse(std::ifstream(scratch.path("report.json")));
  const Json& interface = report["views"][0]["memory_interface"];
  CHECK(report["config"]["dram"]["io_pj_per_bit"].is_null());
  CHECK(interface["io_pj_per_bit"] == 7);
  CHECK(interface["area_known"] == true);
}

TEST_CASE("configuration: a memory whose energy is not stated has none, and every line says so") {
  const ScratchFolder scratch;
  Json memspec = Json::parse(run_streaminggs({"describe", "--memspec", "lpddr4_3200_8gb"}).out,
                             nullptr, true, true);
  for (auto& [name, set] : memspec["currents"].items())
    for (const char* rail : {"vdd1_ma", "vdd2_ma"})
      for (auto& [current, ma] : set[rail].items()) ma = 0;
  memspec["io_pj_per_bit"] = memspec["io_pj_per_bit_low"] = memspec["io_pj_per_bit_high"] = 0;
  const std::string file = scratch.write("mine.json", memspec.dump());
  const auto run = [&](const Arguments& frames) {
    const Outcome done = run_streaminggs(with_settings(
        joined({"simulate", "builtin:object?n=50", "--size", "32x18", "--out", scratch.path("")},
               frames),
        {"dram.memspec=" + file}));
    INFO(done.err);
    REQUIRE(done.status == 0);
    CHECK_THAT(done.out, Contains("the memory's energy is not known: lpddr4_3200_8gb does not "
                                  "state currents and I/O energy (dram.io_pj_per_bit)\n"));
    CHECK_THAT(done.out, !Contains("of it DRAM"));
    return done.out;
  };
  const auto report = [&] { return Json::parse(std::ifstream(scratch.path("report.json"))); };
  const std::string still = run({"--view", "0", "--frame-rate", "90"});
  CHECK_THAT(still, Contains(") mJ without the memory; "));
  CHECK_THAT(still, Contains(" W without the memory: ") && Contains(" >0.0"));
  const Json view = report()["views"][0];
  for (const Json& costs : {view["energy"], view["fixed_rates"][0]["rest"]}) {
    CHECK_FALSE(costs.contains("dram_j"));
  }
  CHECK(view["energy"]["memory_known"] == false);
  CHECK(view["fixed_rates"][0]["memory_known"] == false);
  CHECK_THAT(run({"--path", "builtin:path", "--frames", "2"}),
             Contains("90 frames a second without the memory: "));
  CHECK(report()["summary"]["memory_known"] == false);
}

TEST_CASE("configuration: the memory's interface is of a memory that is named") {
  struct Row {
    Arguments settings;
    double pj;
    const char *source, *whose, *says;
  };
  for (const auto& [settings, pj, source, whose, says] :
       {Row{{"dram.memspec=lpddr4_3200_8gb"},
            3,
            "LPDDR3's value",
            "lpddr4_3200_8gb, estimated from lpddr3_1600",
            "\nlpddr4_3200_8gb: PHY and controller are not known, lpddr3_1600's are counted by "
            "peak bandwidth; I/O 3 (2 .. 4) pJ/bit: own choice (low confidence): LPDDR3's value"},
        Row{{"dram.io_pj_per_bit=0.5"}, 0.5, "dram.io_pj_per_bit", "lpddr3_1600", ""}}) {
    INFO(settings[0]);
    const ScratchFolder scratch;
    const Outcome done = run_streaminggs(with_settings(
        {"simulate", "builtin:object?n=50", "--size", "32x18", "--out", scratch.path("")},
        settings));
    REQUIRE(done.status == 0);
    CHECK_THAT(done.out, Contains("with PHY and controller of " + std::string(whose) + "\n") &&
                             Contains(says));
    const Json report = Json::parse(std::ifstream(scratch.path("report.json")));
    const Json& interface = report["views"][0]["memory_interface"];
    CHECK(interface["area_of"] == "lpddr3_1600");
    CHECK(interface["area_known"] == (*says == '\0'));
    CHECK(interface["io_pj_per_bit"] == pj);
    // A number that is given has no band, the memspec's has that of LPDDR3.
    const bool given = *says == '\0';
    CHECK(interface["io_pj_per_bit_low"] == (given ? pj : 2));
    CHECK(interface["io_pj_per_bit_high"] == (given ? pj : 4));
    CHECK_THAT(interface["io_source"].get<std::string>(), Contains(source));
  }
}

TEST_CASE("configuration: a machine's name alone is the preset of its name, or as little away") {
  const ScratchFolder scratch;
  for (const auto& [machine, differs] : std::vector<std::pair<std::string, const char*>>{
           {"exact", ""},
           {"paper", R"(, "rendering": {"cluster_lanes": 162}, "storage": {"encoding": "vq"})"}}) {
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

// Units that are there several times have one row for each of their activities and counters.
TEST_CASE(
    "configuration: what describe lists of units are those of a frame, without their numbers") {
  const std::regex number("[0-9]+"), row(R"(\| `(\S+)` \| `(\S+)` \| .*)");
  const auto begins = [](const std::string& line, const char* text) {
    return line.rfind(text, 0) == 0;
  };
  for (const char* preset : {"exact", "paper_no_vq", "gscore"}) {
    INFO(preset);
    const Simulation simulation({"builtin:object?n=50", "--size", "16x16", "--config", preset});
    std::map<std::string, std::set<std::pair<std::string, std::string>>> wanted, listed;
    for (const auto& [unit, of] : simulation.views()[0]["units"].items()) {
      for (const char* what : {"activities", "counters"}) {
        for (const auto& [name, value] : of[what].items()) {
          wanted[what].insert({std::regex_replace(unit, number, "N"), name});
        }
      }
    }
    std::istringstream lines(run_streaminggs({"describe", "--config", preset}).out);
    std::string what;
    for (std::string line; std::getline(lines, line) && !begins(line, "| component |");) {
      if (begins(line, "| unit | activity |")) what = "activities";
      if (begins(line, "| unit | counter |")) what = "counters";
      std::smatch parts;
      if (!std::regex_match(line, parts, row)) continue;
      CHECK(listed[what].insert({parts[1], parts[2]}).second);
    }
    CHECK(listed == wanted);
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

// Paths of a report's values, without the numbers of units. A configuration is one value; a list of
// objects has the paths of its elements.
void add_paths(const Json& value, const std::string& path, std::set<std::string>& paths) {
  const bool whole = path == "config" || path == "views" || path == "stream.all";
  if (value.is_object() && !whole) {
    for (const auto& [key, part] : value.items()) {
      const std::string name =
          path == "units" ? std::regex_replace(key, std::regex("[0-9]+"), "N") : key;
      add_paths(part, path.empty() ? name : path + "." + name, paths);
    }
  } else if (value.is_array() && !value.empty() && value[0].is_object() && !whole) {
    for (const Json& element : value) add_paths(element, path + "[]", paths);
  } else {
    paths.insert(path);
  }
}

// Entries of the table that begins with `head`. In their paths names in capitals stand for any key;
// those of units have dots in them.
std::set<std::string> described_entries(const std::string& described, const std::string& head) {
  std::set<std::string> entries;
  std::istringstream lines(described.substr(described.find(head)));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.empty()) {
    if (line.rfind("| `", 0) == 0) entries.insert(line.substr(3, line.find('`', 3) - 3));
  }
  return entries;
}

std::regex pattern_of(const std::string& entry) {
  std::string text = std::regex_replace(entry, std::regex(R"([.[\]])"), R"(\$&)");
  text = std::regex_replace(text, std::regex("PATH|REQUESTER"), ".+");
  return std::regex(std::regex_replace(text, std::regex("[A-Z]{2,}"), "[^.]+"));
}

void check_entries(const std::set<std::string>& entries, const std::set<std::string>& paths) {
  REQUIRE_FALSE(entries.empty());
  std::set<std::string> unknown = paths, missing;
  for (const std::string& entry : entries) {
    const std::regex pattern = pattern_of(entry);
    const std::regex list = pattern_of(entry.substr(0, entry.rfind("[]")));  // if it is empty
    bool met = false;
    for (const std::string& path : paths) {
      const bool is_entry = std::regex_match(path, pattern);
      if (is_entry || std::regex_match(path, list)) unknown.erase(path);
      met = met || is_entry;
    }
    if (!met) missing.insert(entry);
  }
  CHECK(unknown == std::set<std::string>{});
  CHECK(missing == std::set<std::string>{});
}

TEST_CASE("configuration: what describe lists of report.json is what reports hold") {
  const std::string described = run_streaminggs({"describe"}).out;
  const ScratchFolder scratch;
  const Arguments scene = {"builtin:object?n=1500", "--size", "64x36"};
  const std::string packed = scratch.path("scene.sgs");
  REQUIRE(run_streaminggs({"pack", scene[0], "--config", "exact", "--out", packed}).status == 0);
  std::vector<Camera> cameras = open_scene(scene[0]).cameras;
  for (Camera& camera : cameras) camera.principal_offset = {2, 1};
  write_cameras(scratch.path("cameras.json"), cameras);
  write_ply(scratch.path("scene.ply"), open_scene(scene[0]).cloud);
  std::set<std::string> paths;
  for (const Arguments& run :
       {joined(scene, {"--config", "paper", "--set", "storage.vq.iterations=1", "--set",
                       "stated_area_mm2=5", "--frame-rate", "90"}),
        Arguments{scratch.path("scene.ply"), "--cameras", scratch.path("cameras.json"), "--size",
                  "64x36", "--scene-axes", "rub"},
        joined(scene, {"--config", "gscore", "--stereo", "ipd=0.1"}),
        Arguments{packed, "--cameras", scratch.path("cameras.json"), "--size", "64x36"}}) {
    REQUIRE(
        run_streaminggs(joined(joined({"simulate"}, run), {"--out", scratch.path("out")})).status ==
        0);
    add_paths(Json::parse(bytes_of(scratch.path("out/view_0/report.json"))), "", paths);
  }
  check_entries(described_entries(described, "| entry of a view's report.json"), paths);
}

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
  REQUIRE(run_streaminggs({"simulate", "builtin:object?n=100", "--size", "32x18", "--path",
                           "builtin:path", "--frames", "2", "--out", scratch.path("path")})
              .status == 0);
  std::set<std::string> paths;
  add_paths(report, "", paths);
  add_paths(Json::parse(bytes_of(scratch.path("path/report.json"))), "", paths);
  REQUIRE(
      run_streaminggs({"simulate", "builtin:object?n=100", "--size", "32x18", "--path",
                       "builtin:path", "--frames", "2", "--stream", "--frame-rate", "90",
                       "--stereo", "ipd=0.1", "--fit-memories", "--out", scratch.path("stream")})
          .status == 0);
  add_paths(Json::parse(bytes_of(scratch.path("stream/report.json"))), "", paths);
  check_entries(
      described_entries(run_streaminggs({"describe"}).out, "| entry of report.json of all"), paths);
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
