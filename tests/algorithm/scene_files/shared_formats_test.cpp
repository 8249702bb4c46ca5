// Files that others wrote, where they are at hand.
#include <catch2/catch.hpp>

#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/support/shared_inputs.h"

using namespace sgs;

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
