// What is left out of a scene: its count against one made elsewhere, and the same pixels with more
// work where it is not left out. That is by a switch, or by a scene of the same picture that needs
// what the other does not.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/system/left_out_checks.h"

namespace sgs::test {
namespace {

TEST_CASE("left out: bands of colours that the scene does not have, or does not need") {
  const MadeScene whole(padded(cloud_of(diagonal()), 3));
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    for (const int degree : {0, 1, 2}) {
      const MadeScene scene(padded(cloud_of(diagonal()), degree));
      check(std::string(machine) + " " + std::to_string(degree), scene.arguments(machine, {}),
            whole.arguments(machine, {}), {{"sh_bands", known(4), region("second_halves")}});
    }
    // All of the scene's bands are noughts, which no colour misses.
    check(machine, whole.arguments(machine, {"storage.sh_tolerance=1e-6"}),
          whole.arguments(machine, {}), {{"sh_bands_below_tolerance", known(4), bytes()}});
  }
}

TEST_CASE("left out: what bands below the tolerance change stays below what is stated") {
  GaussianCloud cloud = padded(cloud_of(diagonal()), 3);
  for (std::size_t i = 0; i < cloud.sh_coeffs.size(); ++i) {
    if (i % 16 >= 9) cloud.sh_coeffs[i] = glm::vec3(0.0004F);  // of degree 3
    if (i % 16 >= 1 && i % 16 < 9) cloud.sh_coeffs[i] = glm::vec3(0.01F);
  }
  // Seven coefficients of 0.0004 in a band that adds at most sqrt(7 / (4 pi)) of their length.
  const double error = std::sqrt(7 / (4 * M_PI)) * std::sqrt(7.0) * 0.0004;
  const MadeScene scene(cloud);
  const Simulation with(scene.arguments("exact", {"storage.sh_tolerance=0.00196"}));
  with.check();
  const Json& view = with.views()[0];
  CHECK(view["scene"]["sh_degree"] == 2);
  const auto changed = view["image"]["max_abs_error"].get<double>();
  CHECK(changed > 0);
  CHECK(changed <= error);
  for (const Json& entry : view["left_out"]) {
    if (entry["what"] != "sh_bands_below_tolerance") continue;
    const std::string why = entry["why"];
    CHECK(std::stod(why.substr(why.rfind(' '))) == Approx(error).epsilon(0.01));
  }
  // A packed scene does not bring what was left out.
  const ScratchFolder folder;
  const Arguments of_scene = scene.arguments("exact", {});
  const Outcome packed =
      run_streaminggs({"pack", of_scene[0], "--set", "storage.sh_tolerance=0.00196", "--config",
                       "exact", "--out", folder.path("a.sgs")});
  REQUIRE(packed.status == 0);
  CHECK(packed.out.find("sh bands left out         1") != std::string::npos);
  Arguments of_packed = of_scene;
  of_packed[0] = folder.path("a.sgs");
  const Simulation restored(of_packed);
  CHECK(restored.frame(0) == with.frame(0));
  CHECK(restored.views()[0]["image"]["reference"] == "decoded_scene");
  CHECK(left_out(restored.views()[0], "sh_bands_below_tolerance") == 4);
  const Simulation below(scene.arguments("exact", {"storage.sh_tolerance=0.0007"}));
  CHECK(below.views()[0]["scene"]["sh_degree"] == 3);
  CHECK(left_out(below.views()[0], "sh_bands_below_tolerance") == 0);
}

TEST_CASE("left out: Gaussians that no view can show") {
  std::vector<Ball> balls = diagonal();
  // So many that they take pages of their own.
  constexpr int kInvisible = 400;
  for (int i = 0; i < kInvisible; ++i) {
    balls.push_back({at_pixel(32, 32, 5), 0.02F, kBlack, false});
  }
  const MadeScene scene(cloud_of(balls));
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    check(machine, scene.arguments(machine, {}),
          scene.arguments(machine, {"storage.store_invisible=true"}),
          {{"invisible_gaussians", known(kInvisible), of_scene("stored_bytes")}});
  }
}

// Words of all codebooks together.
std::uint64_t words(const Json& view) {
  std::uint64_t sum = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    sum += codebook["entries"].get<std::uint64_t>() * codebook["words"].get<std::uint64_t>();
  }
  return sum;
}
std::uint64_t entries(const Json& view) {
  std::uint64_t sum = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    sum += codebook["entries"].get<std::uint64_t>();
  }
  return sum;
}

TEST_CASE("left out: codebooks, their words, their entries, their load") {
  const Arguments vq = {"storage.encoding=vq_packed", "sram.codebook_bytes=256000"};
  const std::vector<Ball> balls = diagonal();
  // Behind the camera stand so many other colours.
  constexpr std::uint32_t kOthers = 299;
  std::vector<Ball> many = balls;
  for (std::uint32_t i = 0; i < kOthers; ++i) {
    many.push_back({{0, 0, -4}, 0.02F, glm::vec3(0.001F * static_cast<float>(i + 1))});
  }
  const MadeScene plain(cloud_of(balls)), colourful(cloud_of(many));
  for (const char* machine : {"exact", "paper"}) {
    INFO(machine);
    check("raw", plain.arguments(machine, {"storage.encoding=raw", "sram.codebook_bytes=256000"}),
          plain.arguments(machine, vq), {{"codebooks", known(3), region("codebooks")}});
    for (const int degree : {0, 1, 2}) {
      const MadeScene scene(padded(cloud_of(balls), degree)), whole(padded(cloud_of(balls), 3));
      check("degree " + std::to_string(degree), scene.arguments(machine, vq),
            whole.arguments(machine, vq),
            {{"codebook_words", [](const Json& a, const Json& b) { return words(b) - words(a); },
              region("codebooks")}});
    }
    // 4,096 scales, rotations and colours at most; all have one scale and one rotation.
    constexpr std::uint64_t kMost = 3 * 4096;
    check("entries", plain.arguments(machine, vq), colourful.arguments(machine, vq),
          {{"codebook_entries", [](const Json& view, const Json&) { return kMost - entries(view); },
            region("codebooks"), kMost - 3 - kOthers},
           // Three times 12 bits; 300 colours are told apart by 9.
           {"index_bits", known(36), region("codebooks"), 36 - 9}});
    check("load", plain.arguments(machine, plus(vq, {"codebook.preloaded=true"})),
          plain.arguments(machine, vq), {{"codebook_load", known(1), region("codebooks")}});
  }
}

// Eight Gaussians that lie close together: a chunk.
void add_cluster(std::vector<Ball>& balls, const glm::vec3& middle, const glm::vec3& dc,
                 bool visible = true) {
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
    balls.push_back({middle + 0.01F * corner, 0.02F, dc, visible});
  }
}

TEST_CASE("left out: chunks that no group needs, groups that see none") {
  // Two in groups of the diagonal, three behind the camera; or those, black, in other groups.
  std::vector<Ball> unseen, seen;
  for (std::vector<Ball>* balls : {&unseen, &seen}) {
    add_cluster(*balls, at_pixel(8, 8, 4), {1, 0.5F, 0});
    add_cluster(*balls, at_pixel(40, 40, 4), {0, 0.5F, 1});
  }
  for (const float x : {8.0F, 24.0F, 56.0F}) {
    add_cluster(unseen, at_pixel(x, 56, 4) * glm::vec3(1, 1, -1), kBlack);
    add_cluster(seen, at_pixel(x, 56, 4), kBlack);
  }
  const MadeScene scene(cloud_of(unseen)), needed(cloud_of(seen));
  check("exact", scene.arguments("exact", {}), needed.arguments("exact", {}),
        {{"chunks_not_needed", known(3), sum("visits")},
         {"empty_groups", known(16 - 2), sum("visits"), 16 - 5}});
  // What lies behind finished pixels is not out of reach, told of or not.
  const MadeScene hidden(layers());
  for (const char* told : {"true", "false"}) {
    const std::string feedback = std::string("rendering.saturation_feedback=") + told;
    const Simulation run(hidden.arguments("exact", {"storage.chunk_gaussians=1", feedback}));
    CHECK(left_out(run.views()[0], "chunks_not_needed") == 0);
  }
}

TEST_CASE("left out: empty cells, voxels that no ray meets, groups that see none") {
  // Voxels of 1: 4 x 4 x 4 of them before the camera, each with eight Gaussians that no view can
  // show; in two of them visible ones, and behind the camera as well.
  std::vector<Ball> balls;
  for (int cell = 0; cell < 64; ++cell) {
    const glm::vec3 at(cell % 4, cell / 4 % 4, cell / 16);
    add_cluster(balls, at + glm::vec3(-1.5F, -1.5F, 10.5F), kBlack, false);
  }
  add_cluster(balls, {-0.5F, -0.5F, 10.5F}, {1, 0.5F, 0});
  add_cluster(balls, {0.5F, 0.5F, 10.5F}, {0, 0.5F, 1});
  const MadeScene scene(cloud_of(balls));
  const Arguments set = {"storage.voxel_size=1"};
  // A voxel is 5.8 px wide on its near side, all are 25.6 px: groups of 16 px around the middle.
  check("paper", scene.arguments("paper_no_vq", set),
        scene.arguments("paper_no_vq", plus(set, {"storage.store_invisible=true"})),
        {{"empty_cells", known(64 - 2), region("voxel_table")},
         {"empty_groups", known(16 - 2), sum("visits"), 16 - 4}});

  std::vector<Ball> unseen, seen;
  for (std::vector<Ball>* of : {&unseen, &seen}) add_cluster(*of, {-0.5F, -0.5F, 10.5F}, {1, 1, 0});
  for (const float x : {-0.5F, 0.5F, 1.5F}) {
    add_cluster(unseen, {x, 0.5F, -10.5F}, kBlack);
    add_cluster(seen, {x, 0.5F, 10.5F}, kBlack);
  }
  const MadeScene behind(cloud_of(unseen)), before(cloud_of(seen));
  check("voxels", behind.arguments("paper_no_vq", set), before.arguments("paper_no_vq", set),
        {{"voxels_not_needed", known(3), sum("first_halves")}});
}

}  // namespace
}  // namespace sgs::test
