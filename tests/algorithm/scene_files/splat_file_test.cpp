// splat_file.h: every field, by the formulas of the format.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

TEST_CASE("splat: centres, scales, colours, opacities, rotations") {
  const test::ScratchFolder scratch;
  const Scene scene = load_scene(scratch.write("a.splat", test::splat_bytes(9)));
  CHECK(scene.form == "splat");
  REQUIRE(scene.cloud.size() == 9);
  REQUIRE(scene.cloud.sh_degree == 0);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto x = static_cast<float>(i);
    CHECK(scene.cloud.means[i] == glm::vec3(x, -x, 0.5f));
    CHECK(scene.cloud.log_scales[i].y == static_cast<float>(std::log(0.25)));
    const double opacity = code(i, 3) / 255.0;
    CHECK(scene.cloud.opacity_logits[i] == static_cast<float>(std::log(opacity / (1 - opacity))));
    double length = 0;
    for (int k = 0; k < 4; ++k) {
      const double part = code(i, 4 + k) / 127.5 - 1;
      length += part * part;
    }
    for (int k = 0; k < 4; ++k) {
      CHECK(scene.cloud.quats[i][k] ==
            Approx((code(i, 4 + k) / 127.5 - 1) / std::sqrt(length)).margin(1e-7));
      if (k == 3) continue;
      const double colour = 0.5 + 0.28209479177387814 * scene.cloud.sh_coeffs[i][k];
      CHECK(colour * 255 == Approx(code(i, k)).margin(1e-5));
    }
  }
}

TEST_CASE("splat: opacities of 0 and 1 stay finite, a scale of 0 is flat") {
  const test::ScratchFolder scratch;
  std::string bytes = test::splat_bytes(2);
  test::put_at(bytes, 12, 0.0F);
  bytes[27] = '\xff';
  bytes[32 + 27] = '\0';
  const Scene scene = load_scene(scratch.write("a.splat", bytes));
  CHECK(scene.cloud.log_scales[0].x == -INFINITY);
  CHECK(scene.cloud.opacity_logits[0] == Approx(std::log(999999.0)));
  CHECK(scene.cloud.opacity_logits[1] == Approx(-std::log(999999.0)));
}

TEST_CASE("splat refuses: sizes between records, scales below 0") {
  const test::ScratchFolder scratch;
  std::string bytes = test::splat_bytes(2);
  const auto refusal = [&](const std::string& of) {
    return test::input_error_of([&] { load_scene(scratch.write("a.splat", of)); });
  };
  CHECK_THAT(refusal(""), Contains("a.splat: got 0 bytes, expected records of 32 bytes"));
  CHECK_THAT(refusal(bytes.substr(1)), Contains("got 63 bytes"));
  test::put_at(bytes, 32 + 16, -1.0F);
  CHECK_THAT(refusal(bytes), Contains("vertex 1, property scale_1: got "));
}
