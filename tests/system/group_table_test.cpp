// groups.csv: what is counted by group of pixels adds up to what the frame counts.
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Columns = std::map<std::string, std::vector<std::uint64_t>>;

// Columns by name. Fails the test where a line is not as long as the first.
Columns read_groups(const std::string& path) {
  std::ifstream file(path);
  std::string line, cell;
  REQUIRE(std::getline(file, line));
  std::vector<std::string> names;
  for (std::istringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  Columns columns;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    for (const std::string& name : names) {
      REQUIRE(std::getline(row, cell, ','));
      columns[name].push_back(std::stoull(cell));
    }
    REQUIRE_FALSE(std::getline(row, cell, ','));
  }
  return columns;
}

std::uint64_t sum_of(const std::vector<std::uint64_t>& values) {
  std::uint64_t all = 0;
  for (const std::uint64_t value : values) all += value;
  return all;
}

std::uint64_t parts_of(const nlohmann::json& config) {
  return config.value("fetch", "") == "shared" ? config["hfus"].get<std::uint64_t>() : 1;
}

void check_groups(const nlohmann::json& view, const Columns& groups) {
  CHECK(sum_of(groups.at("blends")) == view["image"]["blends"]);
  CHECK(sum_of(groups.at("misordered")) == view["image"]["misordered"]);
  CHECK(sum_of(groups.at("missed")) == view["image"]["missed"]);
  // Codebooks are everybody's.
  CHECK(sum_of(groups.at("bytes")) + region_bytes(view, "codebooks", "read") ==
        view["dram"]["bytes"]);
  std::uint64_t pixels = 0;
  for (std::size_t g = 0; g < groups.at("group").size(); ++g) {
    CHECK(groups.at("group")[g] == g);
    pixels += groups.at("width_px")[g] * groups.at("height_px")[g];
  }
  const nlohmann::json& frame = view["frame"];
  CHECK(pixels == frame["width_px"].get<std::uint64_t>() * frame["height_px"].get<std::uint64_t>());
  // Behind the last group there is only its writing.
  const std::uint64_t parts = parts_of(view["config"]);
  CHECK(sum_of(groups.at("cycles")) <= parts * frame_cycles(view));
  CHECK(sum_of(groups.at("cycles")) > parts * frame_cycles(view) / 2);
}

TEST_CASE("groups: counts and bytes of all of them are the frame's") {
  for (const Arguments& machine :
       {with_settings({"--config", "exact"}, {"vsu.upper_nodes=0", "merge.entries=64"}),
        with_settings({"--config", "exact_vq"}, {"vsu.upper_nodes=0", "vsu.queue_entries=16"}),
        with_settings({"--config", "paper"}, {"sorting.buffer_entries=64"}),
        with_settings({"--config", "paper"}, {"fetch=shared"})}) {
    INFO(machine[1] << " " << machine.back());
    const Simulation simulation(
        joined({"builtin:outdoor?n=3000", "--view", "0,1", "--size", "100x60", "--set",
                "group_width_px=32", "--set", "group_height_px=32"},
               machine));
    for (const nlohmann::json& view : simulation.views()) {
      const std::string folder = simulation.folder() + "/out/view_" + view["view"].dump();
      const Columns groups = read_groups(folder + "/groups.csv");
      CHECK(groups.at("group").size() == 4 * 2);
      check_groups(view, groups);
    }
  }
}

TEST_CASE("groups: those of an earlier run go where a machine has none") {
  ScratchFolder out;
  const Arguments scene = {"simulate", "builtin:object?n=500", "--size", "64x36"};
  const std::string groups = out.path("view_0/groups.csv");
  for (const char* config : {"exact", "gscore"}) {
    INFO(config);
    const Outcome outcome =
        run_streaminggs(joined(scene, {"--out", out.path(""), "--config", config}));
    CHECK(outcome.status == 0);
    CHECK(std::filesystem::exists(groups) == (config == std::string("exact")));
  }
}

}  // namespace
}  // namespace sgs::test
