// Tests of algorithm/splat/view.h.
#include "algorithm/splat/view.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/files/input_error.h"

using namespace sgs;

TEST_CASE("largest_stretch bounds the singular values of a rotation that is not quite one") {
  CHECK(largest_stretch(glm::dmat3(1.0)) == 1.0);
  CHECK(largest_stretch(glm::dmat3({1.001, 0, 0}, {0, 1, 0}, {0, 0, 0.999})) == Approx(1.001));
  // Columns 0.01 from orthogonal: singular values sqrt(1 +- 0.01).
  const glm::dmat3 skew({1, 0, 0}, {0.01, std::sqrt(1 - 1e-4), 0}, {0, 0, 1});
  CHECK(largest_stretch(skew) == Approx(std::sqrt(1.01)).epsilon(1e-12));
}

TEST_CASE("make_view refuses frames without pixels and frames too large to count") {
  Camera camera;
  camera.width = 0;
  camera.height = 50;
  camera.focal_x = camera.focal_y = 100;
  CHECK_THROWS_AS(make_view<float>(camera), InputError);
  camera.width = kMaxFramePx + 1;
  CHECK_THROWS_WITH(make_view<float>(camera),
                    "camera 0: size 131073x50 px, expected 1 to 131072 a side");
  camera.width = kMaxFramePx;
  CHECK(make_view<float>(camera).width == kMaxFramePx);
}
