// Extreme inputs: the reference renderer is right, by hand or against double precision.
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

// Every pixel against the oracle. For frames in which no decision of the oracle is within rounding
// of flipping.
void check_pixels(const Camera& camera, const GaussianCloud& cloud, double tolerance) {
  const RenderResult in_float = render(camera, cloud);
  const OracleImage in_double = oracle_render(camera, cloud);
  CHECK(max_abs_error(in_float.image, test::as_image(in_double)) <= tolerance);
  const bool same_contributors = in_float.contributors == in_double.contributors;
  CHECK(same_contributors);
  CHECK(total(in_double.contributors) > 0);
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

void check_empty(const Camera& camera, const GaussianCloud& cloud) {
  const RenderResult result = render(camera, cloud);
  CHECK(total(result.contributors) == 0);
  CHECK(std::all_of(result.transmittance.begin(), result.transmittance.end(),
                    [](float t) { return t == 1; }));
  CHECK(std::all_of(result.image.pixels.begin(), result.image.pixels.end(),
                    [](const glm::vec3& p) { return p == glm::vec3(0); }));
}

}  // namespace

TEST_CASE("empty scene: nothing but background") {
  check_empty(forward_camera(70, 50, 60), GaussianCloud{});
}

TEST_CASE("one Gaussian") {
  GaussianCloud cloud;
  add_ball(cloud, {0.11F, -0.07F, 2}, 0.1, 0.8, {0.9F, 0.5F, 0.1F});
  check_pixels(forward_camera(70, 50, 60), cloud, 1e-6);
}

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

TEST_CASE("a million Gaussians at one point: the first ones finish the pixels") {
  GaussianCloud cloud;
  for (int i = 0; i < 1000000; ++i) {
    const float shade = i < 50 ? static_cast<float>(i) / 50 : 0;
    add_ball(cloud, {0, 0, 2}, 0.1, 0.5, {shade, 1 - shade, 0.5F});
  }
  const Camera camera = forward_camera(70, 50, 60);
  const RenderResult all = render(camera, cloud);
  // In the middle alpha is 0.5 but for a quarter pixel off the centre: 13 layers or one more.
  const std::uint32_t middle = all.contributors[25 * 70 + 35];
  CHECK(middle >= 13);
  CHECK(middle <= 14);
  // The first 2,500 of 10^6 finish even pixels of alpha 1/255.
  GaussianCloud few;
  for (int i = 0; i < 2500; ++i) {
    const float shade = i < 50 ? static_cast<float>(i) / 50 : 0;
    add_ball(few, {0, 0, 2}, 0.1, 0.5, {shade, 1 - shade, 0.5F});
  }
  const RenderResult front = render(camera, few);
  CHECK(max_abs_error(all.image, front.image) == 0);
  const bool same_contributors = all.contributors == front.contributors;
  CHECK(same_contributors);
  check_frame("one point", camera, few);
}

TEST_CASE("coordinates of 10^6 with details of 10^-3") {
  // Positions lie on float's grid, 0.0625 there; the camera does not.
  const glm::vec3 centre(1e6F, -1e6F, 1e6F);
  Camera camera = forward_camera(160, 90, 200);
  camera.position = {1e6 + 0.01237, -1e6 - 0.03411, 1e6 - 1.50173};
  const auto cloud = test::random_cloud(11, 3000, 2, centre, 1, 1e-3F, 0.05F);
  check_frame("coordinates 10^6", camera, cloud);
}

TEST_CASE("extents over 10^5 with details of 10^-3") {
  GaussianCloud cloud = test::random_cloud(12, 3000, 1, {0, 0, 2}, 1, 1e-3F, 0.1F);
  const auto far = test::random_cloud(13, 3000, 1, {0, 0, 1e5F}, 1e5F, 10, 5000);
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(cloud.means, far.means);
  append(cloud.log_scales, far.log_scales);
  append(cloud.quats, far.quats);
  append(cloud.opacity_logits, far.opacity_logits);
  append(cloud.sh_coeffs, far.sh_coeffs);
  check_frame("extents 10^5", forward_camera(160, 90, 200), cloud);
}

TEST_CASE("needles with scale ratios of 10^10") {
  auto cloud = test::random_cloud(14, 400, 0, {0, 0, 5}, 3, 0.3F, 0.5F);
  for (auto& scales : cloud.log_scales) {
    scales = {std::log(0.3F), std::log(0.3e-10F), std::log(0.3e-10F)};
  }
  check_frame("needles", forward_camera(160, 90, 200), cloud);
}

TEST_CASE("opacity 0 shows nothing, opacity 1 is capped at 0.99") {
  const Camera camera = forward_camera(41, 41, 40);
  GaussianCloud cloud;
  add_ball(cloud, {0, 0, 2}, 0.2, 0.5, {1, 0.5F, 0.25F});
  cloud.opacity_logits[0] = -200;
  check_empty(camera, cloud);
  cloud.opacity_logits[0] = 200;
  CHECK(activate(cloud).gaussians[0].opacity == 1);
  const RenderResult result = render(camera, cloud);
  CHECK(result.image.at(20, 20).x == Approx(0.99).epsilon(1e-6));
  CHECK(result.transmittance[20 * 41 + 20] == Approx(0.01).epsilon(1e-5));
  check_pixels(camera, cloud, 1e-6);
}

TEST_CASE("on the camera, on the near plane, behind it: dropped, just in front: drawn") {
  const Camera camera = forward_camera(64, 64, 50);
  const auto at_depth = [](float z) {
    GaussianCloud cloud;
    add_ball(cloud, {0, 0, z}, 0.05, 0.9, {1, 1, 1});
    return cloud;
  };
  for (const float z : {0.0F, 0.2F, 0.1F, -0.2F, -3.0F}) {
    CAPTURE(z);
    check_empty(camera, at_depth(z));
  }
  check_pixels(camera, at_depth(0.2001F), 1e-5);
  // Opaque and large, but its centre is behind: not one pixel.
  GaussianCloud giant;
  add_ball(giant, {0, 0, -0.1F}, 100, 0.99, {1, 1, 1});
  check_empty(camera, giant);
}

TEST_CASE("a giant around everything") {
  const Camera camera = forward_camera(70, 50, 60);
  for (const double scale : {1e3, 1e6, 1e9, 1e12, 1e15}) {
    CAPTURE(scale);
    GaussianCloud cloud;
    add_ball(cloud, {0.5F, -0.25F, 1}, scale, 0.6, {0.25F, 0.5F, 1});
    const RenderResult result = render(camera, cloud);
    for (const auto& pixel : result.image.pixels) {
      REQUIRE(pixel.x == Approx(0.15).epsilon(1e-5));
      REQUIRE(pixel.y == Approx(0.3).epsilon(1e-5));
      REQUIRE(pixel.z == Approx(0.6).epsilon(1e-5));
    }
  }
  GaussianCloud inside = test::random_cloud(15, 1000, 0, {0, 0, 4}, 3, 0.02F, 0.2F);
  add_ball(inside, {0.5F, -0.25F, 1}, 1e6, 0.6, {0.25F, 0.5F, 1});
  check_frame("giant in front", camera, inside);
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

TEST_CASE("frames of 1x1 and of no multiple of 16") {
  const auto cloud = test::random_cloud(16, 2000, 1, {0, 0, 4}, 4, 0.02F, 0.5F);
  for (const auto& [width, height] : {std::pair{1, 1}, {17, 1}, {1, 33}, {101, 47}}) {
    CAPTURE(width, height);
    const Camera camera = forward_camera(width, height, 50);
    const Image in_float = render(camera, cloud).image;
    const Image in_double = test::as_image(oracle_render(camera, cloud));
    CHECK(fraction_within(in_float, in_double, 1e-4) == 1);
  }
}

TEST_CASE("equal depths blend in the order of the file") {
  const Camera camera = forward_camera(70, 50, 60);
  GaussianCloud cloud;
  for (int i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(i * 37 % 101) * 0.02F - 1;
    const float y = static_cast<float>(i * 53 % 97) * 0.02F - 1;
    add_ball(cloud, {x, y, i % 2 == 0 ? 2.0F : 2.5F}, 0.1, 0.6,
             {static_cast<float>(i % 5) / 4, static_cast<float>(i % 7) / 6, 0.5F});
  }
  check_frame("equal depths", camera, cloud);
  GaussianCloud pair;
  add_ball(pair, {0, 0, 2}, 10, 0.75, {1, 0, 0});
  add_ball(pair, {0, 0, 2}, 10, 0.75, {0, 1, 0});
  const auto middle = render(camera, pair).image.at(35, 25);
  CHECK(middle.x == Approx(0.75).epsilon(1e-4));
  CHECK(middle.y == Approx(0.1875).epsilon(1e-4));
}

TEST_CASE("10^5 layers of alpha 1/255 over the whole frame") {
  // T after n layers is (1 - alpha)^n: the last n that leaves 1e-4.
  const double alpha = 1.0 / 254.99;
  const auto expected = static_cast<std::uint32_t>(std::log(1e-4) / std::log1p(-alpha));
  GaussianCloud cloud;
  for (int i = 0; i < 100000; ++i) {
    add_ball(cloud, {0, 0, 1.0F + 1e-4F * static_cast<float>(i)}, 1e5, alpha, {1, 1, 1});
  }
  const RenderResult result = render(forward_camera(640, 360, 500), cloud);
  const auto [fewest, most] =
      std::minmax_element(result.contributors.begin(), result.contributors.end());
  CHECK(*fewest >= expected - 1);
  CHECK(*most <= expected + 1);
  for (const auto& pixel : result.image.pixels) {
    if (!(std::abs(pixel.x - (1 - 1e-4)) <= 1e-4)) FAIL("red is " << pixel.x);
  }
}

TEST_CASE("SH degrees 0 to 3") {
  for (const int degree : {0, 1, 2, 3}) {
    const auto cloud = test::random_cloud(17, 2000, degree, {0, 0, 4}, 4, 0.02F, 0.3F);
    check_frame(fmt::format("degree {}", degree), forward_camera(160, 90, 120), cloud);
  }
}
