// Codebooks of whole scenes: sizes, entries, opacities, and that indices mean what they should.
#include "algorithm/vq/quantise.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/activate.h"
#include "algorithm/vq/vq_points.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/vq/small_config.h"

namespace sgs {
namespace {

ActivatedCloud cloud_of(unsigned seed, std::size_t count, int degree) {
  return activate(test::random_cloud(seed, count, degree, {0, 0, 0}, 3, 0.01F, 1));
}

std::vector<float> even(const ActivatedCloud& cloud) {
  return std::vector<float>(cloud.size(), 1.0F);
}

std::vector<float> unknown(const ActivatedCloud& cloud) {
  return std::vector<float>(cloud.size(), 0.0F);
}

std::size_t entries_of(const QuantisedCloud& quantised, Codebook codebook, int degree) {
  return quantised.codebooks[static_cast<std::size_t>(codebook)].size() /
         codebook_words(codebook, degree);
}

const float* entry_of(const QuantisedCloud& quantised, Codebook codebook, int degree,
                      std::size_t gaussian) {
  const auto id = static_cast<std::size_t>(codebook);
  return quantised.codebooks[id].data() +
         std::size_t{quantised.indices[id][gaussian]} * codebook_words(codebook, degree);
}

TEST_CASE("quantise: no more entries than configured, an index for each Gaussian") {
  for (int degree = 0; degree <= 3; ++degree) {
    const ActivatedCloud cloud = cloud_of(1, 2000, degree);
    const VqConfig config = test::small_config();
    const QuantisedCloud quantised = quantise(cloud, even(cloud), unknown(cloud), config);
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      const auto codebook = static_cast<Codebook>(id);
      if (codebook == Codebook::kSh && degree == 0) {
        CHECK(quantised.codebooks[id].empty());
        CHECK(quantised.indices[id].empty());
        continue;
      }
      const std::size_t entries = entries_of(quantised, codebook, degree);
      CHECK(entries == config.entries(codebook));  // 2000 distinct values fill each
      CHECK(quantised.codebooks[id].size() == entries * codebook_words(codebook, degree));
      REQUIRE(quantised.indices[id].size() == cloud.size());
      for (const std::uint32_t index : quantised.indices[id]) REQUIRE(index < entries);
    }
    CHECK(quantised.opacities.size() == cloud.size());
  }
}

TEST_CASE("quantise: ratios fall from exactly 1, quaternions have length 1") {
  const ActivatedCloud cloud = cloud_of(2, 3000, 1);
  const QuantisedCloud quantised =
      quantise(cloud, even(cloud), unknown(cloud), test::small_config());
  const auto& ratios = quantised.codebooks[static_cast<std::size_t>(Codebook::kScale)];
  for (std::size_t at = 0; at < ratios.size(); at += 3) {
    CHECK(ratios[at] == 1.0F);
    CHECK(ratios[at + 1] <= 1);
    CHECK(ratios[at + 2] <= ratios[at + 1]);
    CHECK(ratios[at + 2] >= 0);
  }
  const auto& quats = quantised.codebooks[static_cast<std::size_t>(Codebook::kRotation)];
  for (std::size_t at = 0; at < quats.size(); at += 4) {
    double squared = 0;
    for (std::size_t k = 0; k < 4; ++k) squared += std::pow(static_cast<double>(quats[at + k]), 2);
    CHECK(squared == Approx(1).epsilon(5e-7));
  }
}

TEST_CASE("quantise: with room for all, each Gaussian gets its own values back") {
  const ActivatedCloud cloud = cloud_of(3, 400, 2);
  const QuantisedCloud quantised = quantise(cloud, even(cloud), unknown(cloud), VqConfig{});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    const CanonicalShape shape = canonical_shape(g.scale, g.quat);
    const float* ratios = entry_of(quantised, Codebook::kScale, 2, i);
    const float* quat = entry_of(quantised, Codebook::kRotation, 2, i);
    for (int axis = 0; axis < 3; ++axis) {
      // Through a logarithm in 32 bits.
      CHECK(std::abs(ratios[axis] - shape.scale[axis] / shape.scale[0]) < 1e-6F);
    }
    for (std::size_t k = 0; k < 4; ++k) CHECK(std::abs(quat[k] - shape.quat[k]) < 1e-6F);
    const float* dc = entry_of(quantised, Codebook::kDc, 2, i);
    const float* sh = entry_of(quantised, Codebook::kSh, 2, i);
    for (int word = 0; word < 27; ++word) {
      CHECK((word < 3 ? dc[word] : sh[word - 3]) == cloud.sh(i)[word / 3][word % 3]);
    }
  }
  CHECK(entries_of(quantised, Codebook::kDc, 2) <= 400);
  CHECK(entries_of(quantised, Codebook::kSh, 2) == 400);
}

TEST_CASE("quantise: codebooks hold no more entries than there are distinct values") {
  ActivatedCloud cloud = cloud_of(4, 10000, 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.gaussians[i] = cloud.gaussians[i % 3];
    std::copy_n(cloud.sh(i % 5), 4, cloud.sh_coeffs.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  const QuantisedCloud quantised = quantise(cloud, even(cloud), unknown(cloud), VqConfig{});
  CHECK(entries_of(quantised, Codebook::kScale, 1) == 3);
  CHECK(entries_of(quantised, Codebook::kRotation, 1) == 3);
  CHECK(entries_of(quantised, Codebook::kDc, 1) == 5);
  CHECK(entries_of(quantised, Codebook::kSh, 1) == 5);

  const ActivatedCloud nothing;
  const QuantisedCloud empty = quantise(nothing, {}, {}, VqConfig{});
  for (const auto& codebook : empty.codebooks) CHECK(codebook.empty());
}

TEST_CASE("quantise: opacities to the nearest 255th, visible or not as before") {
  ActivatedCloud cloud;
  const std::vector<float> opacities = {0,          0.001F,     std::nextafter(1 / 255.0F, 0.0F),
                                        1 / 255.0F, 1.4F / 255, 1.6F / 255,
                                        0.5F,       0.997F,     0.9999F,
                                        1};
  const std::vector<std::uint8_t> expected = {0, 0, 0, 1, 1, 2, 128, 254, 255, 255};
  for (const float opacity : opacities) {
    cloud.gaussians.push_back({{}, {1, 1, 1}, {1, 0, 0, 0}, opacity});
    cloud.sh_coeffs.emplace_back(0.0F);
  }
  CHECK(quantise(cloud, even(cloud), unknown(cloud), VqConfig{}).opacities == expected);
}

TEST_CASE("quantise: the same for one and four threads, another seed gives others") {
  const ActivatedCloud cloud = cloud_of(5, 3000, 1);
  std::vector<QuantisedCloud> results;
  for (const std::size_t threads : {1U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(quantise(cloud, even(cloud), unknown(cloud), test::small_config()));
  }
  CHECK(results[0].codebooks == results[1].codebooks);
  CHECK(results[0].indices == results[1].indices);
  VqConfig other = test::small_config();
  other.seed = 2;
  CHECK(quantise(cloud, even(cloud), unknown(cloud), other).codebooks != results[0].codebooks);
}

TEST_CASE("quantise: a heavy Gaussian is served at the cost of light ones") {
  const ActivatedCloud cloud = cloud_of(7, 2000, 1);
  std::vector<float> weights = even(cloud);
  weights[77] = 1e6F;
  const QuantisedCloud quantised = quantise(cloud, weights, unknown(cloud), test::small_config());
  const float* dc = entry_of(quantised, Codebook::kDc, 1, 77);
  for (int channel = 0; channel < 3; ++channel) {
    CHECK(std::abs(dc[channel] - cloud.sh(77)[0][channel]) < 1e-3F);
  }
}

TEST_CASE("quantise: extreme shapes and colours leave every entry finite") {
  ActivatedCloud cloud = cloud_of(8, 2000, 3);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  cloud.gaussians[0].scale = {0, 0, 0};
  cloud.gaussians[1].scale = {1, 1e-10F, 1e-10F};
  cloud.gaussians[2].scale = {1e-38F, 3e38F, 1};
  cloud.gaussians[3].scale = {kInfinity, 1, kInfinity};
  cloud.gaussians[4].scale = {1, kInfinity, 0};
  for (int k = 0; k < 16; ++k) {
    cloud.sh_coeffs[16 * 5 + static_cast<std::size_t>(k)] = glm::vec3(1e30F);
    cloud.sh_coeffs[16 * 6 + static_cast<std::size_t>(k)] = glm::vec3(-3e38F);
  }
  const QuantisedCloud quantised =
      quantise(cloud, even(cloud), unknown(cloud), test::small_config());
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    CHECK(entries_of(quantised, static_cast<Codebook>(id), 3) ==
          test::small_config().entries(static_cast<Codebook>(id)));
    for (const float word : quantised.codebooks[id]) REQUIRE(std::isfinite(word));
  }
  // A codebook that the huge values have not spoilt for the rest.
  double off = 0;
  for (std::size_t i = 10; i < cloud.size(); ++i) {
    const CanonicalShape shape = canonical_shape(cloud.gaussians[i].scale, cloud.gaussians[i].quat);
    const float* ratios = entry_of(quantised, Codebook::kScale, 3, i);
    off = std::max(off, std::abs(static_cast<double>(ratios[1]) - shape.scale[1] / shape.scale[0]));
  }
  CHECK(off < 0.3);
}

}  // namespace
}  // namespace sgs
