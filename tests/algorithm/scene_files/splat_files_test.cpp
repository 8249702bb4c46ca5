// .ksplat and .splat: every field of every compression, by the formulas of the formats.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

namespace {

// Place of number `n` of a record among channels and coefficients, counted out by hand.
struct Place {
  int channel, coeff;
};
Place place_of(int n) {
  if (n < 9) return {n / 3, n % 3};
  if (n < 24) return {(n - 9) / 5, 3 + (n - 9) % 5};
  return {(n - 24) / 7, 8 + (n - 24) % 7};
}

}  // namespace

TEST_CASE("ksplat: every field of every compression and degree") {
  const test::ScratchFolder scratch;
  for (const int compression : {0, 1, 2}) {
    for (const int degree : {0, 1, 2, 3}) {
      CAPTURE(compression, degree);
      const GaussianCloud cloud =
          load_scene(scratch.write("a.ksplat", test::ksplat_bytes(compression, 10, degree))).cloud;
      REQUIRE(cloud.size() == 10);
      REQUIRE(cloud.sh_degree == degree);
      const int coeffs = sh_coeff_count(degree);
      for (std::size_t i = 0; i < 10; ++i) {
        const double bucket = static_cast<double>(i / 4);
        const double centre[] = {10 * bucket, 0, -bucket};
        for (int axis = 0; axis < 3; ++axis) {
          const double at = compression == 0
                                ? static_cast<double>((axis + 1) * i)
                                : centre[axis] + (256.0 * code(i, axis) - 32767) / 32767 * 2.5;
          CHECK(cloud.means[i][axis] == Approx(at).margin(1e-6));
          const double colour = 0.5 + 0.28209479177387814 * cloud.sh_coeffs[i * coeffs][axis];
          CHECK(colour * 255 == Approx(code(i, 3 + axis)).margin(1e-4));
        }
        CHECK(cloud.log_scales[i].x == static_cast<float>(std::log(0.5)));
        CHECK(cloud.log_scales[i].z == static_cast<float>(std::log(2.0)));
        CHECK(cloud.quats[i] == std::array<float, 4>{0.5f, -0.5f, 0.5f, 0.5f});
        const double opacity = code(i, 6) / 255.0;
        CHECK(cloud.opacity_logits[i] == Approx(std::log(opacity / (1 - opacity))));
        for (int n = 0; n < test::rest_count(degree); ++n) {
          const double value = compression == 2 ? -1.5 + 3 * code(i, 7 + n) / 255.0
                                                : static_cast<double>(n) / 64 - 1;
          const Place place = place_of(n);
          CHECK(cloud.sh_coeffs[i * coeffs + place.coeff + 1][place.channel] ==
                Approx(value).margin(1e-7));
        }
      }
    }
  }
}

TEST_CASE("ksplat refuses: headers that do not fit the file or each other") {
  const test::ScratchFolder scratch;
  const std::string good = test::ksplat_bytes(1, 10, 1);
  const auto refusal = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = good;
    test::put_at(bytes, at, value);
    return test::input_error_of([&] { load_scene(scratch.write("a.ksplat", bytes)); });
  };
  CHECK_THAT(refusal(0, 1), Contains("version 1.0 of .ksplat, expected 0.1"));
  CHECK_THAT(refusal(4, 4000000000U), Contains("the headers of 4000000000 sections"));
  CHECK_THAT(refusal(16, 11), Contains("10 Gaussians in sections, expected 11"));
  CHECK_THAT(refusal(20, 3), Contains("compression 3 of .ksplat"));
  CHECK_THAT(refusal(4096, 11), Contains("section 0 of 11 Gaussians, expected at most 10"));
  CHECK_THAT(refusal(4096 + 4, 4000000000U), Contains("4000000000 records of"));
  CHECK_THAT(refusal(4096 + 8, 3), Contains("8 Gaussians in 3 buckets"));
  CHECK_THAT(refusal(4096 + 12, 4000000000U), Contains("4000000000 buckets of 12 bytes"));
  CHECK_THAT(refusal(4096 + 32, 3), Contains("in 4 buckets"));
  CHECK_THAT(refusal(4096 + 36, 4000000000U), Contains("4000000000 sizes of buckets"));
  CHECK_THAT(refusal(4096 + 40, 4), Contains("SH degree 4, expected 0 to 3"));
}

TEST_CASE("splat: centres, scales, colours, opacities, rotations") {
  const test::ScratchFolder scratch;
  const Scene scene = load_scene(scratch.write("a.splat", test::splat_bytes(9)));
  CHECK(scene.form == "splat");
  REQUIRE(scene.notes.size() == 1);
  CHECK_THAT(scene.notes[0],
             Contains("byte / 127.5 - 1; the form's first viewer takes byte / 128 - 1"));
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
