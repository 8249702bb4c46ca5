// A principal point anywhere, and parameters at their limits: the reference renderer is right
// against double precision. Other extremes are those of hostile_test.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/against_double.h"
#include "tests/algorithm/render/test_clouds.h"

using namespace sgs;
using test::add_ball;
using test::forward_camera;

namespace {

RenderResult render(const Camera& camera, const GaussianCloud& cloud) {
  return render_reference(make_view<float>(camera), activate(cloud));
}

std::uint64_t total(const std::vector<std::uint32_t>& contributors) {
  return std::accumulate(contributors.begin(), contributors.end(), std::uint64_t{0});
}

// A whole frame against the oracle, where decisions may flip as on real scenes.
void check_frame(const std::string& name, const Camera& camera, const GaussianCloud& cloud) {
  test::check_against_double(name, camera, cloud);
  const RenderResult in_float = render(camera, cloud);
  const Image in_double = test::as_image(oracle_render(camera, cloud));
  const double psnr = psnr_db(in_float.image, in_double);
  const double within = fraction_within(in_float.image, in_double, 1e-4);
  fmt::print("{}: {:.1f} dB, {:.3f} % of pixels within 1e-4\n", name, psnr, 100 * within);
  CHECK(psnr >= 65);
  CHECK(within >= 0.997);
}

}  // namespace

TEST_CASE("a principal point beside the middle: against double, and a cut of a larger frame") {
  const GaussianCloud cloud = test::random_cloud(5, 1500, 1, {0, 0, 4}, 1.2F, 0.02F, 0.2F);
  const Camera whole = forward_camera(160, 112, 120);
  // From pixel (48, 32), where a tile begins.
  Camera cut = forward_camera(96, 64, 120);
  cut.principal_offset = {80 - 48 - 48, 56 - 32 - 32};
  check_frame("beside the middle", cut, cloud);
  const Image large = render(whole, cloud).image, small = render(cut, cloud).image;
  Image part(96, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 96; ++x) part.at(x, y) = large.at(48 + x, 32 + y);
  }
  CHECK(fraction_within(part, small, 1e-4) >= 0.997);
  CHECK(psnr_db(part, small) >= 65);
  Camera middle = cut;
  middle.principal_offset = {0, 0};
  CHECK(psnr_db(part, render(middle, cloud).image) < 40);
}

TEST_CASE("at the limits of parameters: drawn as in double precision") {
  struct Case {
    const char* what;
    glm::vec3 mean;
    double scale, focal_px;
    float rgb;
    std::size_t pixels;  // that are covered, of 70x50
  };
  const auto limit = static_cast<float>(kMaxCoordinate);
  for (const Case& c : {
           Case{"the largest, before the eye of the longest", {0, 0, 0.21F}, 1e7, 1e9, 1, 3500},
           {"the largest, to the side", {1e7F, 0, 1}, 1e7, 60, 1, 3500},
           {"the largest, 2.95 sigma to the side", {3.7e7F, 0, 1}, 1e7, 60, 1, 3500},
           {"the largest, 3.03 sigma to the side", {3.8e7F, 0, 1}, 1e7, 60, 1, 0},
           {"far away, a point", {0, 0, limit}, 1e7, 60, 1, 12},
           {"far away, seen from near", {0, 0, 1e16F}, 1e7, 1e9, 1, 44},
           {"far to the side", {limit, -limit, 1}, 1e7, 1e9, 1, 0},
           {"far behind", {0, 0, -limit}, 1e7, 60, 1, 0},
           {"the brightest", {0, 0, 2}, 0.2, 60, 2e17F, 1152},
           {"the darkest", {0, 0, 2}, 0.2, 60, -2e17F, 1152},
       }) {
    CAPTURE(c.what);
    GaussianCloud cloud;
    add_ball(cloud, c.mean, c.scale, 0.6, glm::vec3(c.rgb));
    const Camera camera = forward_camera(70, 50, c.focal_px);
    const RenderResult in_float = render(camera, cloud);
    const OracleImage in_double = oracle_render(camera, cloud);
    CHECK(in_float.contributors == in_double.contributors);
    CHECK(total(in_float.contributors) == c.pixels);
    const double unit = std::max(1.0, std::abs(static_cast<double>(c.rgb)));
    for (std::size_t at = 0; at < in_double.pixels.size(); ++at) {
      const double error = std::abs(in_float.image.pixels[at].y - in_double.pixels[at].y) / unit;
      REQUIRE(error <= 1e-5);
    }
  }
}
