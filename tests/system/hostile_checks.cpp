// The runs of a case, as a user would start them.
#include "tests/system/hostile_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/decisions.h"
#include "tests/algorithm/render/pixel_bounds.h"
#include "tests/system/frame_checks.h"
#include "tests/system/hostile_cases.h"
#include "tests/system/hostile_settings.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// Of these no configuration needs more; what is drawn is then refused for its own sake alone.
constexpr const char* kRoom[] = {"sram.input_bytes=1073741824", "sram.codebook_bytes=1073741824",
                                 "sram.shared_bytes=1073741824"};

class HostileRun {
 public:
  HostileRun(std::uint64_t seed, HostileTotals& totals)
      : case_(hostile_case(seed)), random_(seed), totals_(totals) {
    write_ply(folder_.path("scene.ply"), case_.cloud);
    write_cameras(folder_.path("cameras.json"), case_.cameras);
  }

  const HostileCase& hostile() const { return case_; }

  void run() {
    ++totals_.cases;
    if (!case_.refused.empty()) return run_refused();
    check_against_double();
    for (const char* machine : {"exact", "paper", "gscore", "gscore_lossless_boxes"})
      simulate(machine);
    pack();
    tune();
  }

 private:
  Arguments scene_arguments(const char* command, const std::string& scene) const {
    return {command, folder_.path(scene), "--cameras", folder_.path("cameras.json")};
  }

  Outcome run(const Arguments& arguments) {
    // What does not end is a fault as well.
    return run_program("timeout", joined({"-k", "5", "300", SGS_STREAMINGGS}, arguments));
  }

  // Status 2, one line with one of the words behind notes, nothing written under `out`.
  void check_refusal(const Arguments& arguments, const Outcome& outcome, const std::string& out,
                     const std::vector<std::string>& words) {
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("streaminggs" << command << "\nstatus " << outcome.status << ": " << outcome.err);
    CHECK(outcome.status == 2);
    const std::regex one_line("(streaminggs: note: .*\n)*streaminggs: (?!note: ).*\n");
    CHECK(std::regex_match(outcome.err, one_line));
    CHECK(std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return outcome.err.find(word) != std::string::npos;
    }));
    CHECK_FALSE(std::filesystem::exists(folder_.path(out)));
  }

  void run_refused() {
    ++totals_.refused_scenes;
    for (const Arguments& more : std::vector<Arguments>{{"simulate", "--config", "exact"},
                                                        {"simulate", "--config", "paper"},
                                                        {"simulate", "--config", "gscore"},
                                                        {"render", "--view", "0"},
                                                        {"pack", "--config", "exact_vq"},
                                                        {"tune", "--boundary", "--steps", "1"}}) {
      const char* out = more[0] == "simulate" ? "out"
                        : more[0] == "render" ? "out.pfm"
                        : more[0] == "pack"   ? "out.sgs"
                                              : "out.ply";
      const Arguments arguments = joined(
          joined(scene_arguments(more[0].c_str(), "scene.ply"), {more.begin() + 1, more.end()}),
          {"--out", folder_.path(out)});
      check_refusal(arguments, run(arguments), out, {case_.refused});
    }
  }

  void check_against_double() {
    for (const Camera& camera : case_.cameras) {
      INFO("camera " << camera.id << " against double precision");
      const RenderResult drawn = render_reference(make_view<float>(camera), activate(case_.cloud));
      references_.emplace(camera.id, drawn.image);
      const Decisions decisions = compare_decisions(camera, case_.cloud);
      INFO(decisions.first_unexplained);
      CHECK(decisions.unexplained == 0);
      if (decisions.near_plane > 0) continue;  // pixels of other splats cannot be compared
      const PixelBounds bounds = bound_pixels(camera, case_.cloud, drawn);
      INFO(bounds.first_outside);
      CHECK(bounds.outside == 0);
      totals_.pixels += bounds.pixels;
      totals_.narrow_pixels += bounds.narrow;
    }
  }

  Arguments draw(const std::string& preset, int count) {
    Arguments drawn = drawn_settings(random_, preset, count);
    const bool tiles = preset.rfind("gscore", 0) == 0;
    // Mostly enough memory on chip.
    if (random_() % 8 != 0) {
      if (tiles) {
        drawn.emplace_back("sram.buffer_bytes=1073741824");
      } else {
        drawn.insert(drawn.end(), std::begin(kRoom), std::end(kRoom));
      }
    }
    if (preset == "paper" && random_() % 2 == 0) {
      const double size =
          std::exp(std::log(1e-3) + std::log(1e8) * 0x1p-64 * static_cast<double>(random_()));
      drawn.push_back(fmt::format("storage.voxel_size={:.4g}", size));
    }
    if (random_() % 4 != 0) drawn.emplace_back("framebuffer=rgb32f");
    return drawn;
  }

  // Keys that a refusal of these settings may name, whole or within their section.
  static std::vector<std::string> keys_of(const Arguments& drawn) {
    std::vector<std::string> keys = {"dram: the scene and its frame take", "bytes are there"};
    for (const std::string& setting : drawn) {
      const std::string key = setting.substr(0, setting.find('='));
      keys.push_back(key.substr(key.rfind('.') + 1));
      if (keys.back() == "voxel_rule") keys.emplace_back("voxel_size");
    }
    return keys;
  }

  // Draws until a machine is built, each time less, at last the preset as it is.
  void simulate(const std::string& preset) {
    for (int count : {12, 5, 2, 0}) {
      Arguments drawn = count > 0 ? draw(preset, count) : Arguments{"framebuffer=rgb32f"};
      if (count == 0 && preset == "paper") drawn.emplace_back("storage.voxel_size=0");
      Arguments arguments =
          joined(scene_arguments("simulate", "scene.ply"), {"--view", "all", "--config", preset});
      if (random_() % 3 == 0) {
        arguments =
            joined(arguments, {"--stalls", "0.05", "--seed", std::to_string(random_() % 99)});
      }
      arguments = joined(with_settings(arguments, drawn), {"--out", folder_.path("out")});
      if (drawn_right(arguments, keys_of(drawn))) return;
    }
    FAIL_CHECK("the preset " << preset << " refuses the scene");
  }

  // Whether it was not refused.
  bool drawn_right(const Arguments& arguments, const std::vector<std::string>& keys) {
    const Outcome outcome = run(arguments);
    if (outcome.status == 2) {
      ++totals_.refused_settings;
      check_refusal(arguments, outcome, "out", keys);
      return false;
    }
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("streaminggs" << command << "\nstatus " << outcome.status << ": " << outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.err.find("Warning") == std::string::npos);
    if (outcome.status == 0) {
      for (const Json& view : views_of_report(folder_.path("out/report.json"))) {
        check_view(view);
        const int camera = view["view"];
        check_reference(view, folder_.path("out"), references_.at(camera));
        ++totals_.frames;
        totals_.blends += view["image"]["blends"].get<std::uint64_t>();
      }
    }
    std::filesystem::remove_all(folder_.path("out"));
    return true;
  }

  static void check_view(const Json& view) {
    check_frame(view);
    if (view["config"]["machine"] == "gscore") {
      const Json& tiles = view["config"]["tiles"];
      if (tiles["reach"] == "visible" && tiles["features"] == "fp32" && tiles["keys"] == "fp32" &&
          view["config"]["rendering"]["precision"] == "fp32" && gives_nothing_away(view)) {
        CHECK(view["image"]["max_abs_error"] == 0.0);
      }
    }
  }

  static bool gives_nothing_away(const Json& view) {
    const Json& storage = view["config"]["storage"];
    return storage["encoding"] == "raw" && storage["sh_tolerance"] == 0.0 &&
           view["config"]["framebuffer"] == "rgb32f";
  }

  void pack() {
    constexpr const char* kPresets[] = {"exact",           "exact_half", "exact_vq",
                                        "exact_vq_packed", "paper",      "paper_no_vq"};
    const std::string preset = kPresets[random_() % std::size(kPresets)];
    Arguments of_storage = {"--config", preset};
    if (preset.find("vq") != std::string::npos && preset != "paper_no_vq") {
      of_storage = with_settings(of_storage, {"storage.vq.iterations=3"});
    }
    const Arguments packing = joined(joined(scene_arguments("pack", "scene.ply"), of_storage),
                                     {"--out", folder_.path("scene.sgs")});
    const Outcome packed = run(packing);
    INFO("pack for " << preset << ": status " << packed.status << " " << packed.err);
    if (packed.status == 2) return check_refusal(packing, packed, "scene.sgs", {"scene.ply"});
    REQUIRE(packed.status == 0);
    const auto frames = [&](const char* scene, const Arguments& more) {
      const Outcome outcome = run(with_settings(
          joined(joined(scene_arguments("simulate", scene),
                        {"--view", "all", "--out", folder_.path(scene + std::string("_"))}),
                 more),
          {"framebuffer=rgb32f"}));
      INFO(scene << ": " << outcome.err);
      REQUIRE(outcome.status == 0);
      std::string all;
      for (const Camera& camera : case_.cameras) {
        all += bytes_of(folder_.path(fmt::format("{}_/view_{}/frame.exr", scene, camera.id)));
      }
      return all;
    };
    const bool same = frames("scene.sgs", {"--config", preset}) == frames("scene.ply", of_storage);
    CHECK(same);
  }

  void tune() {
    const char* const modes[] = {"--boundary", "--quantise", "--streaming"};
    const std::string mode = modes[random_() % 3];
    const std::string out = mode == "--quantise" ? "tuned.sgs" : "tuned.ply";
    Arguments tuning =
        joined(scene_arguments("tune", "scene.ply"),
               {mode, "--steps", "3", "--test-every", "2", "--out", folder_.path(out)});
    if (mode == "--quantise") tuning = joined(tuning, {"--reassign-every", "2"});
    tuning = joined(tuning, {"--config", mode == "--streaming" ? "exact" : "paper"});
    const Outcome outcome = run(tuning);
    INFO("tune " << mode << ": status " << outcome.status << " " << outcome.err);
    if (outcome.status == 2) {
      return check_refusal(tuning, outcome, out, {"scene.ply", "cameras.json"});
    }
    // A step beyond what a scene may hold ends it, the last good state kept.
    if (outcome.status == 1) {
      CHECK(outcome.err.rfind("streaminggs: step ", 0) == 0);
      CHECK(outcome.err.find("the last good state is in ") != std::string::npos);
      CHECK(std::filesystem::exists(folder_.path(out + ".checkpoint")));
      CHECK_FALSE(std::filesystem::exists(folder_.path(out)));
      return;
    }
    REQUIRE(outcome.status == 0);
    if (mode != "--quantise") {
      const GaussianCloud tuned = read_ply(folder_.path(out)).cloud;  // refuses what is not finite
      CHECK(tuned.size() <= case_.cloud.size());
    } else {
      CHECK(run({"info", folder_.path(out)}).status == 0);
    }
  }

  const HostileCase case_;
  std::mt19937_64 random_;
  HostileTotals& totals_;
  ScratchFolder folder_;
  std::map<int, Image> references_;  // [camera]
};

}  // namespace

void check_hostile(std::uint64_t seed, HostileTotals& totals) {
  HostileRun run(seed, totals);
  INFO("seed " << seed << " (" << run.hostile().what << "): again with " << SGS_HOSTILE
               << " --seeds " << seed << ":1");
  run.run();
}

std::string to_text(const HostileTotals& t) {
  return fmt::format(
      "{} cases, {} frames, {} blends; {} scenes and {} configurations refused; {} of {} pixels "
      "bounded to 1/512",
      t.cases, t.frames, t.blends, t.refused_scenes, t.refused_settings, t.narrow_pixels, t.pixels);
}

}  // namespace sgs::test
