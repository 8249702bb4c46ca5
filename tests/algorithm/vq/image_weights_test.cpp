// Weights against a plain loop over pixels and splats.
#include "algorithm/vq/image_weights.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs {
namespace {

using test::forward_camera;

ActivatedCloud small_cloud(unsigned seed, std::size_t count = 60) {
  return activate(test::random_cloud(seed, count, 1, {0, 0, 4}, 1.5F, 0.05F, 0.6F));
}

// Camera `shift` to the side of the origin.
Camera shifted(double shift, int width, int height) {
  Camera camera = forward_camera(width, height, 40);
  camera.position = {shift, 0, 0};
  return camera;
}

// Sum over pixels of (T alpha)^2 of each Gaussian, pixel after pixel.
std::vector<double> squared_shares(const ActivatedCloud& cloud, const Camera& camera) {
  const View<float> view = make_view<float>(camera);
  std::vector<Splat> splats;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Splat splat{};
    if (!make_geometry(view, cloud.gaussians[i], splat)) continue;
    splat.index = static_cast<std::uint32_t>(i);
    splats.push_back(splat);
  }
  std::stable_sort(splats.begin(), splats.end(),
                   [](const Splat& a, const Splat& b) { return a.depth < b.depth; });
  std::vector<double> sums(cloud.size(), 0.0);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      double light = 1;
      for (const Splat& s : splats) {
        const PixelRect covered = footprint_px(s.footprint, {0, 0, camera.width, camera.height});
        if (x < covered.x0 || x >= covered.x1 || y < covered.y0 || y >= covered.y1) continue;
        const float alpha = alpha_at(s.conic_a, s.conic_b, s.conic_c, s.opacity,
                                     s.x - static_cast<float>(x), s.y - static_cast<float>(y));
        if (alpha == 0) continue;
        if (light * (1 - alpha) < 1e-4) break;
        sums[s.index] += std::pow(light * alpha, 2);
        light *= 1 - static_cast<double>(alpha);
      }
    }
  }
  return sums;
}

std::vector<double> capped_sizes(const ActivatedCloud& cloud) {
  std::vector<double> sizes;
  for (const Gaussian<float>& g : cloud.gaussians) {
    const double a = g.scale.x, b = g.scale.y, c = g.scale.z;
    sizes.push_back(g.opacity * (a * b + b * c + c * a));
  }
  std::vector<double> sorted = sizes;
  std::sort(sorted.begin(), sorted.end());
  for (double& size : sizes) size = std::min(size, sorted[sorted.size() * 99 / 100]);
  return sizes;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST_CASE("image weights: 0.7 of the squared shares of pixels and 0.3 of the sizes") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const ActivatedCloud cloud = small_cloud(seed);
    // Odd sizes: the last sub-tiles are cut by the frame.
    const std::vector<Camera> cameras = {shifted(0, 61, 43), shifted(0.7, 37, 50)};
    std::vector<double> seen(cloud.size(), 0.0);
    for (const Camera& camera : cameras) {
      const std::vector<double> of_view = squared_shares(cloud, camera);
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += of_view[i];
    }
    CHECK(std::count_if(seen.begin(), seen.end(), [](double sum) { return sum > 0; }) > 20);
    const std::vector<double> sizes = capped_sizes(cloud);
    const std::vector<float> weights = image_weights(cloud, cameras);
    REQUIRE(weights.size() == cloud.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double expected = 0.7 * seen[i] / mean(seen) + 0.3 * sizes[i] / mean(sizes) + 1e-6;
      CHECK(weights[i] == Approx(expected).epsilon(1e-3));
    }
  }
}

TEST_CASE("image weights: without cameras, or with ones that see nothing, by size") {
  const ActivatedCloud cloud = small_cloud(4);
  const std::vector<double> sizes = capped_sizes(cloud);
  Camera away = forward_camera(20, 20, 20);
  away.position = {0, 0, 1000};
  const std::vector<float> none = image_weights(cloud, {}), nothing = image_weights(cloud, {away});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CHECK(none[i] == Approx(sizes[i] / mean(sizes) + 1e-6).epsilon(1e-5));
    CHECK(nothing[i] == Approx(0.3 * sizes[i] / mean(sizes) + 1e-6).epsilon(1e-5));
  }
}

TEST_CASE("image weights: all positive and finite, whatever the Gaussians") {
  ActivatedCloud cloud = small_cloud(5, 300);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  cloud.gaussians[0].scale = {0, 0, 0};
  cloud.gaussians[1].scale = {1e30F, 1e30F, 1e30F};
  cloud.gaussians[2].scale = {kInfinity, 0, 1};
  cloud.gaussians[3].scale = {kInfinity, kInfinity, kInfinity};
  cloud.gaussians[3].opacity = 0;
  cloud.gaussians[4].opacity = 0;
  cloud.gaussians[5].opacity = 1;
  double sum = 0;
  for (const auto& cameras : {std::vector<Camera>{}, {forward_camera(64, 48, 40)}}) {
    const std::vector<float> weights = image_weights(cloud, cameras);
    sum = 0;
    for (const float weight : weights) {
      CHECK(weight > 0);
      CHECK(std::isfinite(weight));
      sum += weight;
    }
    CHECK(sum == Approx(300).epsilon(1e-3));  // of mean 1: none has lost its part
  }
}

TEST_CASE("image weights: the same bits whatever the number of threads") {
  const ActivatedCloud cloud = small_cloud(6, 3000);
  const std::vector<Camera> cameras = {shifted(0, 200, 150), shifted(-0.5, 150, 200)};
  std::vector<std::vector<float>> results;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(image_weights(cloud, cameras));
  }
  CHECK(results[1] == results[0]);
  CHECK(results[2] == results[0]);
}

TEST_CASE("image weights: of many cameras 64, evenly spaced") {
  const ActivatedCloud cloud = small_cloud(7);
  std::vector<Camera> all, used;
  for (int c = 0; c < 200; ++c) all.push_back(shifted(0.01 * c, 24, 20));
  for (std::size_t c = 0; c < 64; ++c) used.push_back(all[c * 200 / 64]);
  CHECK(image_weights(cloud, all) == image_weights(cloud, used));
  CHECK(image_weights(cloud, all) != image_weights(cloud, {all.begin(), all.begin() + 64}));
}

TEST_CASE("image weights: large pictures are rendered smaller") {
  const ActivatedCloud cloud = small_cloud(8);
  const Camera large = forward_camera(4096, 1024, 2000);  // 2^22 px: half the sides
  const Camera half = forward_camera(2048, 512, 1000);
  CHECK(image_weights(cloud, {large}) == image_weights(cloud, {half}));
}

}  // namespace
}  // namespace sgs
