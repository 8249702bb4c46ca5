// Within gaussian_cloud.h nothing leaves float: no Gaussian in front of a camera is dropped for
// want of range.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/visible_extents.h"
#include "tests/algorithm/splat/random_gaussian.h"

using namespace sgs;

namespace {

// A number at a limit, near it, or anywhere below, of either sign.
double extreme(test::RandomGaussians& random, double limit) {
  const double sizes[] = {limit, limit * random.uniform(0.1, 1), random.log_uniform(1e-6, limit),
                          0};
  return (random.pick(2) == 0 ? 1 : -1) * sizes[random.pick(4)];
}

Camera extreme_camera(test::RandomGaussians& random) {
  Camera camera = random.camera();
  camera.width = random.pick(2) == 0 ? kMaxFramePx : 1 + random.pick(1000);
  camera.height = random.pick(2) == 0 ? kMaxFramePx : 1 + random.pick(1000);
  camera.focal_x = std::max(1e-6, std::abs(extreme(random, kMaxFocalPx)));
  camera.focal_y = random.pick(2) == 0 ? camera.focal_x : random.log_uniform(1e-6, kMaxFocalPx);
  for (int k = 0; k < 3; ++k) camera.position[k] = extreme(random, kMaxCoordinate);
  if (random.pick(2) == 0) camera.position = glm::dvec3(0);
  if (random.pick(3) == 0) camera.world_from_camera *= 1.0005;  // as much as the reader lets pass
  return camera;
}

// Anywhere, or as near in front of the camera as can be.
Gaussian<float> extreme_gaussian(test::RandomGaussians& random, const Camera& camera) {
  Gaussian<float> g = random.gaussian(camera);
  glm::dvec3 mean(0.0);
  for (int k = 0; k < 3; ++k) mean[k] = extreme(random, kMaxCoordinate);
  if (random.pick(2) == 0) {
    const glm::dvec3 v(extreme(random, 1e6), extreme(random, 1e6), random.uniform(0.2, 0.21));
    mean = camera.world_from_camera * v + camera.position;
  }
  for (int k = 0; k < 3; ++k) {
    const double limit = kMaxCoordinate;
    g.mean[k] = static_cast<float>(std::min(limit, std::max(-limit, mean[k])));
    g.scale[k] = static_cast<float>(std::abs(extreme(random, kMaxScale)));
  }
  g.opacity = 1;
  return g;
}

}  // namespace

TEST_CASE("within the limits of parameters nothing leaves float") {
  test::RandomGaussians random(9, 640, 360);
  int in_front = 0, largest = 0;
  for (int round = 0; round < 200'000; ++round) {
    const Camera camera = extreme_camera(random);
    const View<float> view = make_view<float>(camera);
    const Gaussian<float> g = extreme_gaussian(random, camera);
    const glm::vec3 v = to_camera(view, g.mean);
    REQUIRE(std::isfinite(v.x + v.y + v.z));
    if (!(v.z > 0.2F)) continue;
    ++in_front;
    const Projected<float> p = project(view, g, v);
    REQUIRE(std::isfinite(p.cov_a + p.cov_c));
    REQUIRE(std::isfinite(p.x + p.y));
    largest += p.cov_a > 1e33F || p.cov_c > 1e33F;
    // What covers the frame from its middle is drawn.
    const float middle_px = 0.1F * static_cast<float>(std::min(view.width, view.height));
    const bool covers =
        std::abs(p.x - view.centre_x) < middle_px && std::abs(p.y - view.centre_y) < middle_px;
    Splat splat{};
    if (covers) REQUIRE(make_geometry(view, g, splat));
    if (covers) {
      const auto scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
      const PixelRect frame{0, 0, view.width, view.height};
      REQUIRE(touches(coarse_bound(view, g.mean, scale_max), frame));
      REQUIRE(may_touch_frame(view, frame_sides(view), g.mean, scale_max));
      const VisibleExtents known = decode_extents(encode_extents(visible_extents(g)));
      REQUIRE(touches(extent_bound(view, g.mean, known.extent, known.scale_max), frame));
    }
    glm::vec3 sh[16];
    for (glm::vec3& coefficient : sh) {
      for (int channel = 0; channel < 3; ++channel) {
        coefficient[channel] = static_cast<float>(extreme(random, kMaxCoefficient));
      }
    }
    add_colour(view, 3, g.mean, sh, splat);
    REQUIRE(std::isfinite(splat.rgb.x + splat.rgb.y + splat.rgb.z));
  }
  CHECK(in_front > 50'000);
  CHECK(largest > 100);
}

TEST_CASE("cameras beyond the limits are refused by what is beyond") {
  struct Case {
    const char* what;
    double focal_x, focal_y, position_y;
    const char* message;  // empty: drawn
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Case& c : {
           Case{"at the limits", 1e9, 1e9, 1e18, ""},
           {"below zero", 1, 1, -1e18, ""},
           {"focal x", 1.01e9, 1, 0,
            "camera 7: focal lengths 1010000000 and 1 px, expected at most 1000000000"},
           {"focal y", 1, 1e30, 0,
            "camera 7: focal lengths 1 and 1e+30 px, expected at most 1000000000"},
           {"no number of px", 1, kNan, 0,
            "camera 7: focal lengths 1 and nan px, expected at most 1000000000"},
           {"position", 1, 1, -1.5e18,
            "camera 7: position 3 -1.5e+18 4, expected magnitudes of at most 1e+18"},
           {"not a number", 1, 1, kNan,
            "camera 7: position 3 nan 4, expected magnitudes of at most 1e+18"},
       }) {
    CAPTURE(c.what);
    Camera camera;
    camera.id = 7;
    camera.width = camera.height = 10;
    camera.focal_x = c.focal_x;
    camera.focal_y = c.focal_y;
    camera.position = {3, c.position_y, 4};
    if (c.message[0] == '\0') {
      CHECK(make_view<float>(camera).focal_x == static_cast<float>(c.focal_x));
    } else {
      CHECK_THROWS_WITH(make_view<float>(camera), c.message);
    }
  }
}
