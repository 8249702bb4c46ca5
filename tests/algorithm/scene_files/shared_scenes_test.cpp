// Real trained scenes and files of others, where they are at hand: counts, degrees, extents, forms,
// and the way back to a file.
#include <catch2/catch.hpp>
#include <glm/common.hpp>

#include "algorithm/scene/describe.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/shared_inputs.h"

using namespace sgs;

namespace {

struct Expected {
  const char* name;
  std::size_t count;
  int degree;
  double inner_reach;  // about the largest |coordinate| of the inner extent
};

SceneSummary check_scene(const Expected& expected) {
  const Scene scene = load_scene(test::shared_scene(expected.name));
  CHECK(scene.name == expected.name);
  CHECK(scene.cloud.size() == expected.count);
  CHECK(scene.cloud.sh_degree == expected.degree);
  const SceneSummary summary = summarise(scene.cloud);
  CHECK(summary.count == expected.count);
  glm::vec3 reach =
      glm::max(glm::abs(summary.inner_extent.min), glm::abs(summary.inner_extent.max));
  const double inner = std::max({reach.x, reach.y, reach.z});
  CHECK(inner > 0.3 * expected.inner_reach);
  CHECK(inner < 3.0 * expected.inner_reach);
  return summary;
}

}  // namespace

TEST_CASE("shared scenes: truck", "[shared]") { check_scene({"truck", 116'544, 0, 3}); }

TEST_CASE("shared scenes: playbot", "[shared]") { check_scene({"playbot", 125'000, 2, 2}); }

TEST_CASE("shared scenes: platform, with needles", "[shared]") {
  const SceneSummary summary = check_scene({"platform", 300'000, 0, 2000});
  CHECK(summary.max_scale_ratio > 1e9);
}

TEST_CASE("shared scenes: yard, there and back byte for byte", "[shared][nightly]") {
  const SceneSummary summary = check_scene({"yard", 300'000, 3, 75});
  CHECK(summary.second_half_bytes == 300'000ull * 220);
  const test::ScratchFolder scratch;
  const std::string path = test::shared_scene("yard");
  write_ply(scratch.path("yard.ply"), load_scene(path).cloud);
  CHECK(test::bytes_of(scratch.path("yard.ply")) == test::bytes_of(path));
}

TEST_CASE("shared scenes: garden", "[shared][nightly]") {
  check_scene({"garden", 851'756, 0, 800});
}

TEST_CASE("shared scenes: park", "[shared][nightly]") { check_scene({"park", 1'699'714, 0, 55}); }

TEST_CASE("shared formats: playbot as SOG is playbot bit for bit", "[shared]") {
  const GaussianCloud got = load_scene(test::shared_path("formats/playbot_sog")).cloud;
  const GaussianCloud expected = read_ply(test::shared_scene("playbot")).cloud;
  REQUIRE(got.size() == expected.size());
  REQUIRE(got.sh_degree == expected.sh_degree);
  CHECK(got.means == expected.means);
  CHECK(got.log_scales == expected.log_scales);
  CHECK(got.quats == expected.quats);
  CHECK(got.opacity_logits == expected.opacity_logits);
  CHECK(got.sh_coeffs == expected.sh_coeffs);
}

TEST_CASE("shared formats: fixtures of splat-transform hold four Gaussians", "[shared]") {
  for (const char* name : {"minimal-raw.spz", "minimal-v2.spz", "minimal-v3.spz", "minimal-v4.spz",
                           "minimal.ksplat", "minimal.splat"}) {
    CAPTURE(name);
    const Scene scene = load_scene(test::shared_path(std::string("formats/fixtures/") + name));
    CHECK(scene.cloud.size() == 4);
  }
}
