// Whole frames of built-in scenes through the command: right and accounted for, whatever the order
// and the stalls.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

Arguments group_of(const std::string& width, const std::string& height) {
  return settings({"group_width_px=" + width, "group_height_px=" + height});
}

// Room for groups of any size, and for ordering tables of any number of voxels.
Arguments roomy(const std::string& order) {
  Arguments room = settings({"sram.shared_bytes=1073741824", "sram.input_bytes=1073741824"});
  if (order == "paper") room.insert(room.end(), {"--set", "vsu.table_bytes=67108864"});
  return room;
}

TEST_CASE("whole frame: the same pixels with and without stalls") {
  for (const char* order : {"paper", "exact"}) {
    for (const char* scene : {"builtin:object?n=3000", "builtin:outdoor?n=3000"}) {
      INFO(order << " " << scene);
      const Arguments common =
          with_settings({scene, "--view", "0,2", "--size", "96x54", "--config", order},
                        {"group_width_px=32", "group_height_px=32"});
      const Simulation plain(common);
      plain.check();
      bool slower = false;  // a few stalls may send the memory its commands in a better order
      for (const Arguments& variant :
           {Arguments{"--stalls", "0.1"}, Arguments{"--stalls", "0.3", "--seed", "2"}}) {
        const Simulation other(joined(common, variant));
        other.check();
        REQUIRE(other.views().size() == plain.views().size());
        bool stalled = false;
        for (std::size_t v = 0; v < plain.views().size(); ++v) {
          CHECK(other.frame(v) == plain.frame(v));
          stalled = stalled || frame_cycles(other.views()[v]) != frame_cycles(plain.views()[v]);
          slower = slower || frame_cycles(other.views()[v]) > frame_cycles(plain.views()[v]);
        }
        CHECK(stalled);
      }
      CHECK(slower);
    }
  }
}

// What the shortest borders are is tested in group_for_frame_test.cpp.
TEST_CASE("whole frame: groups that are left to the model cut the frame evenly") {
  for (const char* order : {"paper", "exact"}) {
    INFO(order);
    const Simulation simulation(joined({"builtin:object?n=2000", "--size", "640x360", "--config",
                                        order, "--set", "storage.encoding=raw"},
                                       group_of("0", "0")));
    simulation.check();
    const auto config = simulation.views()[0]["config"];
    const int width = config["group_width_px"].get<int>(),
              height = config["group_height_px"].get<int>();
    CHECK(width > 32);
    CHECK(height > 32);
    // No column or row of the groups is much narrower than the others.
    CHECK(640 % width + 4 * (640 / width + 1) > width * (640 % width != 0));
    CHECK(360 % height + 8 * (360 / height + 1) > height * (360 % height != 0));
  }
}

// In half precision a splat may reach a pixel just beyond its ellipse, unless the fine filter of
// that pixel's part has dropped it.
TEST_CASE("whole frame: pixels in half where parts of a group meet") {
  for (const auto& [hfus, precision] : {std::pair{"1", "fp16"}, {"4", "fp16"}, {"4", "fixed16"}}) {
    for (const auto& [width, height] : {std::pair{"8", "8"}, {"24", "16"}}) {
      INFO(hfus << " " << precision << " " << width << " x " << height);
      Simulation(
          joined(with_settings({"builtin:object?n=20000", "--size", "160x96", "--config", "paper"},
                               {"storage.encoding=raw", "fetch=shared", std::string("hfus=") + hfus,
                                std::string("rendering.precision=") + precision}),
                 joined(group_of(width, height), roomy("paper"))))
          .check();
    }
  }
}

TEST_CASE("whole frame: groups that are ordered in passes, with and without stalls, paper order",
          "[nightly]") {
  const Arguments common = {
      "builtin:outdoor?n=3000", "--view", "all", "--size", "64x36", "--config", "paper", "--set",
      "vsu.table_bytes=128"};
  const Simulation plain(common), stalled(joined(common, {"--stalls", "0.2", "--seed", "5"}));
  plain.check();
  stalled.check();
  for (std::size_t v = 0; v < plain.views().size(); ++v) {
    CHECK(counter(plain.views()[v], "vsu", "overflows") > 0);
    CHECK(counter(plain.views()[v], "vsu", "ordering_table_bytes_max") <= 128);
    CHECK(stalled.frame(v) == plain.frame(v));
  }
}

TEST_CASE("whole frame: sampled rays, paper order") {
  const Arguments common = {
      "builtin:object?n=3000",     "--size", "64x36", "--config", "paper", "--set",
      "vsu.sample_step_voxels=0.5"};
  Simulation(common).check();
  // Voxels by the coordinates of samples; tables on chip, then mostly in DRAM.
  const Arguments sampled =
      joined(common, {"--set", "vsu.samples_per_cycle=2", "--set", "sram.shared_bytes=0"});
  Simulation(sampled).check();
  const Simulation narrow(
      joined(sampled, {"--set", "storage.voxel_size=0.2", "--set", "vsu.renaming=dense", "--set",
                       "vsu.renaming_bytes=128", "--set", "vsu.adjacency_lines=1", "--set",
                       "vsu.adjacency_destinations=1"}));
  narrow.check();
  CHECK(counter(narrow.views()[0], "vsu", "adjacency_lines_back") > 0);
  CHECK(region_bytes(narrow.views()[0], "adjacency", "write") > 0);
  CHECK(region_bytes(narrow.views()[0], "renaming_table", "read") > 0);
  // Who waits for edges is told so.
  const Simulation edges(joined(sampled, {"--set", "vsu.adjacency_lines=1"}));
  const nlohmann::json traverse = edges.views()[0]["units"]["vsu"]["activities"]["traverse"];
  for (const nlohmann::json& wait : traverse["waits"]) {
    if (wait["for"] == "reads") CHECK(wait["key"] == "vsu.adjacency_lines");
  }
  CHECK(counter(edges.views()[0], "vsu", "adjacency_lines_back") > 0);
}

TEST_CASE("whole frame: the report names the camera and the table that prices were taken from") {
  const ScratchFolder scratch;
  std::vector<Camera> cameras = make_builtin_scene("builtin:object?n=300").cameras;
  cameras[1].id = 77;
  cameras[1].name = "seventy-seven";
  write_cameras(scratch.path("cameras.json"), cameras);
  const auto provenance_with = [&](const std::string& table) {
    std::ofstream(scratch.path("table.json")) << table;
    const Simulation simulation({"builtin:object?n=300", "--size", "32x18", "--view", "1",
                                 "--cameras", scratch.path("cameras.json"), "--technology",
                                 scratch.path("table.json")});
    const nlohmann::json& view = simulation.views()[0];
    CHECK(view["view"] == 1);
    CHECK(view["camera"]["id"] == 77);
    CHECK(view["camera"]["img_name"] == "seventy-seven");
    CHECK(view["provenance"]["technology"] == "32 nm");
    CHECK(view["provenance"]["technology_path"] == scratch.path("table.json"));
    return view["provenance"]["technology_xxh64"].get<std::string>();
  };
  const std::string shipped = bytes_of(SGS_TECHNOLOGY);
  CHECK(provenance_with(shipped) == provenance_with(shipped));
  CHECK(provenance_with(shipped) != provenance_with(shipped + "\n"));
  const Outcome told =
      run_streaminggs({"simulate", "builtin:object?n=300", "--size", "32x18", "--technology",
                       scratch.path("table.json"), "--out", scratch.path("out")});
  CHECK(told.out.find("costs by " + scratch.path("table.json") + ", 32 nm") != std::string::npos);
}

}  // namespace
}  // namespace sgs::test
