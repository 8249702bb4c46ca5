// describe.h against numbers worked out by hand.
#include "algorithm/scene/describe.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sgs;

namespace {

GaussianCloud line_of(std::size_t count, int degree) {
  GaussianCloud cloud;
  cloud.resize(count, degree);
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    cloud.means[i] = {x, -2 * x, 5};
    cloud.log_scales[i] = {0, 0, 0};
    cloud.quats[i] = {1, 0, 0, 0};
    cloud.opacity_logits[i] = 0;
  }
  return cloud;
}

}  // namespace

TEST_CASE("scene summary: an empty scene is all zeros") {
  const SceneSummary summary = summarise(GaussianCloud{});
  CHECK(summary.count == 0);
  CHECK(summary.extent.max == glm::vec3(0));
  CHECK(summary.max_scale == 0);
  CHECK(summary.second_half_bytes == 0);
}

TEST_CASE("scene summary: extents and their quantiles by nearest rank") {
  // 0.1 % of 2000 steps is rank 2, 99.9 % is rank 1998.
  const SceneSummary summary = summarise(line_of(2001, 0));
  CHECK(summary.count == 2001);
  CHECK(summary.extent.min == glm::vec3(0, -4000, 5));
  CHECK(summary.extent.max == glm::vec3(2000, 0, 5));
  CHECK(summary.inner_extent.min == glm::vec3(2, -3996, 5));
  CHECK(summary.inner_extent.max == glm::vec3(1998, -4, 5));
}

TEST_CASE("scene summary: scales and their ratio") {
  GaussianCloud cloud = line_of(3, 0);
  cloud.log_scales = {{0, -1, -2}, {2, 1, 0}, {-3, 1, -12}};
  const SceneSummary summary = summarise(cloud);
  CHECK(summary.max_scale == Approx(std::exp(2.0)));
  CHECK(summary.median_scale == Approx(std::exp(1.0)));  // of 0, 2, 1
  CHECK(summary.max_scale_ratio == Approx(std::exp(13.0)));
}

TEST_CASE("scene summary: opacities below 1/255 are counted") {
  GaussianCloud cloud = line_of(5, 0);
  const float threshold = -std::log(254.0f);  // sigmoid of it is 1/255
  cloud.opacity_logits = {threshold - 0.001f, threshold + 0.001f, 0.0f, 3.0f, -90.0f};
  const SceneSummary summary = summarise(cloud);
  CHECK(summary.invisible_count == 2);
  CHECK(summary.median_opacity == Approx(1.0 / 255.0).epsilon(0.01));
}

TEST_CASE("scene summary: bytes of the halves by degree") {
  const std::vector<std::uint64_t> second_half = {40, 76, 136, 220};
  for (int degree = 0; degree <= 3; ++degree) {
    const SceneSummary summary = summarise(line_of(10, degree));
    CHECK(summary.sh_degree == degree);
    CHECK(summary.first_half_bytes == 160);
    CHECK(summary.second_half_bytes == 10 * second_half[degree]);
  }
}
