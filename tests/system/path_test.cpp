// A camera path: each of its frames is the frame that the view alone gives, but for codebooks that
// stay in the machine.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::string kPathScene = "builtin:object?n=2000";

json run_path(const ScratchFolder& scratch, const Arguments& arguments) {
  const Outcome done = run_streaminggs(
      joined({"simulate", kPathScene, "--size", "96x54", "--out", scratch.path("out")}, arguments));
  INFO(done.out << done.err);
  REQUIRE(done.status == 0);
  return json::parse(bytes_of(scratch.path("out/report.json")));
}

TEST_CASE("path: frames at its keys are the views, on every machine") {
  const ScratchFolder scratch;
  const std::vector<Camera> cameras = make_builtin_scene(kPathScene).cameras;
  write_cameras(scratch.path("keys.json"), {cameras[0], cameras[2]});
  for (const char* preset : {"exact", "paper_no_vq", "gscore"}) {
    INFO(preset);
    const json path = run_path(scratch, {"--config", preset, "--path", scratch.path("keys.json"),
                                         "--frames", "3", "--set", "framebuffer=rgb32f"});
    const Simulation views({kPathScene, "--size", "96x54", "--config", preset, "--view", "0,2"});
    REQUIRE(path["views"].size() == 3);
    for (const int end : {0, 1}) {
      const json& frame = path["views"][2 * end];
      const json& view = views.views()[static_cast<std::size_t>(end)];
      CHECK(frame["view"] == 2 * end);
      CHECK(frame["camera"]["position"] == view["camera"]["position"]);
      for (const auto& [section, content] : view.items()) {
        INFO(section);
        const bool of_run = section == "host" || section == "provenance";
        if (!of_run && section != "view" && section != "camera") CHECK(frame[section] == content);
      }
    }
    CHECK(path["views"][1]["frame"]["cycles"] != path["views"][0]["frame"]["cycles"]);
    CHECK(path["config"] == views.views()[0]["config"]);
  }
}

TEST_CASE("path: of nerfstudio every frame is drawn as it stands, at its rate") {
  const ScratchFolder scratch;
  const std::vector<Camera> cameras = make_builtin_scene(kPathScene).cameras;
  json frames = json::array();
  for (const int i : {0, 2, 1}) {
    const Camera& camera = cameras[static_cast<std::size_t>(i)];
    const glm::dmat3& axes = camera.world_from_camera;
    json numbers = json::array();
    for (int row = 0; row < 3; ++row) {
      for (const double number :
           {axes[0][row], -axes[1][row], -axes[2][row], camera.position[row]}) {
        numbers.push_back(number);
      }
    }
    for (const double number : {0.0, 0.0, 0.0, 1.0}) numbers.push_back(number);
    frames.push_back({{"camera_to_world", numbers},
                      {"fov", 2 * std::atan(0.5 * camera.height / camera.focal_y) * 180 / M_PI}});
  }
  const json file = {{"render_width", cameras[0].width},
                     {"render_height", cameras[0].height},
                     {"camera_path", frames},
                     {"fps", 24},
                     {"seconds", 0.125},
                     {"is_cycle", true}};
  std::ofstream(scratch.path("path.json")) << file;
  const json path = run_path(scratch, {"--path", scratch.path("path.json")});
  REQUIRE(path["views"].size() == 3);
  CHECK(path["summary"]["frame_rate"] == 24);
  const json& middle = path["views"][1]["camera"]["position"];
  for (int axis = 0; axis < 3; ++axis) CHECK(middle[axis] == cameras[2].position[axis]);
  const json other = run_path(
      scratch, {"--path", scratch.path("path.json"), "--frames", "6", "--frame-rate", "30"});
  CHECK(other["views"].size() == 6);
  CHECK(other["summary"]["frame_rate"] == 30);
  // Closed: the last lies between the last and the first.
  CHECK(other["views"][5]["camera"]["position"][0].get<double>() ==
        Approx(0.5 * (cameras[1].position.x + cameras[0].position.x)));
}

TEST_CASE("path: codebooks are loaded once") {
  const ScratchFolder scratch;
  const Arguments machine = {"--config", "exact_vq",
                             "--set",    "storage.vq.iterations=1",
                             "--set",    "sram.codebook_bytes=256000"};
  const json path = run_path(scratch, joined({"--path", "builtin:path", "--frames", "3"}, machine));
  // From where the path begins, in a machine that still has them.
  const std::vector<Camera> keys = builtin_path(kPathScene).keys;
  std::vector<Camera> at_start(5, keys[0]);
  write_cameras(scratch.path("start.json"), at_start);
  write_cameras(scratch.path("weighing.json"), make_builtin_scene(kPathScene).cameras);
  const json still = run_path(scratch, joined({"--path", scratch.path("start.json"), "--cameras",
                                               scratch.path("weighing.json"), "--frames", "3"},
                                              machine));
  CHECK(path["views"][0]["frame"] == still["views"][0]["frame"]);
  const auto bytes = [&](int frame) {
    return still["views"][frame]["dram"]["bytes"].get<std::uint64_t>();
  };
  std::uint64_t codebooks = 0;
  for (const json& book : still["views"][0]["scene"]["codebooks"])
    codebooks += book["bytes"].get<std::uint64_t>();
  CHECK(codebooks > 0);
  CHECK(bytes(0) >= bytes(1) + codebooks);
  CHECK(bytes(0) <= bytes(1) + codebooks + 4 * 256);  // whole lines
  CHECK(bytes(1) == bytes(2));
  CHECK(still["views"][1]["frame"]["cycles"] < still["views"][0]["frame"]["cycles"]);
}

TEST_CASE("path: PHY and controller that are counted take power between frames, too") {
  const ScratchFolder scratch;
  json table = json::parse(bytes_of(SGS_TECHNOLOGY));
  table["memory_interface"]["counted"] = true;
  const std::string counted = scratch.write("counted.json", table.dump());
  const auto path_by = [&](const std::string& technology) {
    return run_path(scratch,
                    {"--path", "builtin:path", "--frames", "2", "--technology", technology});
  };
  const json with = path_by(counted), without = path_by(SGS_TECHNOLOGY);
  double joules = 0;
  for (const json& view : without["views"]) {
    const json& rest = view["fixed_rates"][0]["rest"];
    joules += rest["time_s"].get<double>() * rest["memory_interface_w"]["middle"].get<double>();
  }
  const auto idle_w = [](const json& path) { return path["summary"]["idle_w"].get<double>(); };
  CHECK(joules > 0);
  CHECK(idle_w(with) == Approx(idle_w(without) + joules * 90 / 2));
}

TEST_CASE("fixed rate: of a view as of a path, and none that is not held") {
  const ScratchFolder scratch;
  const Outcome done = run_streaminggs({"simulate", kPathScene, "--size", "96x54", "--view", "0",
                                        "--frame-rate", "90,1e6", "--out", scratch.path("out")});
  INFO(done.err);
  REQUIRE(done.status == 0);
  const json view = json::parse(bytes_of(scratch.path("out/report.json")))["views"][0];
  REQUIRE(view["fixed_rates"].size() == 2);
  const json& rate = view["fixed_rates"][0];
  CHECK(rate["per_s"] == 90);
  CHECK(rate["held"] == true);
  const double rest_s = 1.0 / 90 - view["frame"]["time_s"].get<double>();
  CHECK(rate["rest"]["time_s"].get<double>() == Approx(rest_s));
  CHECK(rate["rest"]["self_refresh_s"].get<double>() == Approx(rest_s).epsilon(1e-3));
  for (const char* end : {"low", "middle", "high"}) {
    INFO(end);
    const double both = view["energy"]["bands"]["total_j"][end].get<double>() +
                        rate["rest"]["bands"]["total_j"][end].get<double>();
    CHECK(rate["energy_j"][end].get<double>() == Approx(both));
    CHECK(rate["power_w"][end].get<double>() == Approx(90 * both));
    CHECK(rate["without_memory_interface_w"][end].get<double>() == Approx(90 * both));
    const double interface = view["energy"]["with_memory_interface_j"][end].get<double>() -
                             view["energy"]["without_memory_interface_j"][end].get<double>() +
                             rest_s * rate["rest"]["memory_interface_w"][end].get<double>();
    CHECK(rate["with_memory_interface_w"][end].get<double>() == Approx(90 * (both + interface)));
  }
  const double leakage_w =
      view["energy"]["sram_leakage_j"].get<double>() / view["frame"]["time_s"].get<double>();
  CHECK(rate["rest"]["sram_leakage_j"].get<double>() == Approx(leakage_w * rest_s));
  CHECK(view["fixed_rates"][1] == json({{"per_s", 1e6}, {"held", false}}));
  CHECK(done.out.find("at 90 frames a second") != std::string::npos);
  CHECK(done.out.find("does not hold 1e+06 frames a second") != std::string::npos);

  const Camera camera = make_builtin_scene(kPathScene).cameras[0];
  write_cameras(scratch.path("keys.json"), {camera, camera});
  const json path = run_path(scratch, {"--path", scratch.path("keys.json"), "--frames", "2"});
  CHECK(path["views"][0]["fixed_rates"][0] == rate);
  CHECK(path["summary"]["energy_a_second_j"].get<double>() ==
        Approx(rate["power_w"]["middle"].get<double>()));
  CHECK(path["summary"]["energy_a_second_high_j"].get<double>() ==
        Approx(rate["power_w"]["high"].get<double>()));
  CHECK(path["summary"]["with_memory_interface_w"].get<double>() ==
        Approx(rate["with_memory_interface_w"]["middle"].get<double>()));
}

TEST_CASE("path: its files, and those of another run in the folder") {
  const ScratchFolder scratch;
  const auto files = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(scratch.path("out"))) {
      if (entry.is_regular_file()) names.insert(fs::relative(entry, scratch.path("out")).string());
    }
    return names;
  };
  const std::set<std::string> of_path = {"report.json", "path.csv", "contact_sheet.png",
                                         "frames/0000.png", "frames/0001.png"};
  run_path(scratch, {"--path", "builtin:path", "--frames", "4"});
  std::ofstream(scratch.path("out/frames/mine.txt")) << "x";
  run_path(scratch, {"--path", "builtin:path", "--frames", "2"});
  auto with_mine = of_path;
  with_mine.insert("frames/mine.txt");
  CHECK(files() == with_mine);
  fs::remove(scratch.path("out/frames/mine.txt"));
  const Arguments view = {"simulate", kPathScene, "--size", "96x54", "--out", scratch.path("out")};
  REQUIRE(run_streaminggs(view).status == 0);
  CHECK(files() == std::set<std::string>{"report.json", "view_0/report.json", "view_0/frame.png",
                                         "view_0/frame.exr", "view_0/reference.png",
                                         "view_0/reference.exr", "view_0/error.png",
                                         "view_0/groups.csv"});
  const json path = run_path(scratch, {"--path", "builtin:path", "--frames", "2"});
  CHECK(files() == of_path);
  std::istringstream table(bytes_of(scratch.path("out/path.csv")));
  std::string head, first;
  std::getline(table, head);
  std::getline(table, first);
  CHECK(head.rfind("frame,cycles,time_s,fps,energy_j,", 0) == 0);
  CHECK(first.rfind("0," + path["views"][0]["frame"]["cycles"].dump() + ",", 0) == 0);
  const json& summary = path["summary"];
  const double slower = std::min(path["views"][0]["frame"]["fps"].get<double>(),
                                 path["views"][1]["frame"]["fps"].get<double>());
  CHECK(summary["worst_fps"] == slower);
  CHECK(summary["late_frames"] == 0);
  CHECK(summary["empty_frames"] == 0);
  CHECK(path["path"]["name"] == "the turntable of " + kPathScene);
  CHECK(summary["frames_w"].get<double>() == Approx(90 * summary["energy_j"].get<double>() / 2));
}

}  // namespace
}  // namespace sgs::test
