// The optimiser against its formula in double.
#include "algorithm/tune/adam.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

constexpr std::size_t kGaussians = 700;
const LearningRates kRates{1e-3, 5e-3, 1e-2, 5e-2, 2.5e-3, 1.25e-4};

GaussianCloud start(int degree) {
  return random_cloud(1, kGaussians, degree, {0, 0, 3}, 1, 0.01F, 0.5F);
}

// Two thirds of the Gaussians, others each step; gradients over many orders of magnitude.
CloudGradient gradient_of_step(unsigned step, int degree) {
  CloudGradient out;
  out.parameters = random_cloud(100 + step, kGaussians, degree, {0, 0, 0}, 1, 0.01F, 0.5F);
  out.centres.resize(kGaussians);
  std::vector<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < kGaussians; ++i) {
    if ((i + step) % 3 != 0) seen.push_back(i);
  }
  const float scale = std::pow(10.0F, -3.0F * static_cast<float>(step % 4));
  for (auto& v : out.parameters.means) v *= scale;
  for (auto& v : out.parameters.sh_coeffs) v *= scale;
  out.resize(seen.size(), degree);
  out.indices = seen;
  return out;
}

std::vector<float> values_of(const GaussianCloud& cloud, std::size_t i) {
  std::vector<float> out;
  const auto add = [&](const glm::vec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); };
  add(cloud.means[i]);
  add(cloud.log_scales[i]);
  out.insert(out.end(), cloud.quats[i].begin(), cloud.quats[i].end());
  out.push_back(cloud.opacity_logits[i]);
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  for (std::size_t c = 0; c < coeffs; ++c) add(cloud.sh_coeffs[i * coeffs + c]);
  return out;
}

double rate_of(std::size_t value) {
  if (value < 3) return kRates.mean;
  if (value < 6) return kRates.log_scale;
  if (value < 10) return kRates.quat;
  if (value < 11) return kRates.opacity_logit;
  return value < 14 ? kRates.sh_dc : kRates.sh_rest;
}

struct Parameter {
  double p = 0, m = 0, v = 0;
};

TEST_CASE("Adam is its formula, for what is seen, at each degree") {
  for (const int degree : {0, 1, 2, 3}) {
    GaussianCloud cloud = start(degree);
    const GaussianCloud before = cloud;
    Adam adam(cloud);
    std::vector<std::vector<Parameter>> exact(kGaussians);
    std::vector<int> updates(kGaussians);
    for (std::size_t i = 0; i < kGaussians; ++i) {
      for (const float p : values_of(cloud, i)) exact[i].push_back({p, 0, 0});
    }
    constexpr int kSteps = 12;
    for (unsigned step = 0; step < kSteps; ++step) {
      const CloudGradient gradient = gradient_of_step(step, degree);
      adam.step(gradient, kRates, cloud);
      for (std::size_t r = 0; r < gradient.size(); ++r) {
        const std::size_t i = gradient.indices[r];
        const std::vector<float> g = values_of(gradient.parameters, r);
        const int n = ++updates[i];
        for (std::size_t k = 0; k < g.size(); ++k) {
          Parameter& x = exact[i][k];
          x.m = 0.9 * x.m + 0.1 * g[k];
          x.v = 0.999 * x.v + 0.001 * g[k] * g[k];
          x.p -= rate_of(k) * (x.m / (1 - std::pow(0.9, n))) /
                 (std::sqrt(x.v / (1 - std::pow(0.999, n))) + 1e-15);
        }
      }
    }
    for (std::size_t i = 0; i < kGaussians; ++i) {
      const std::vector<float> ours = values_of(cloud, i);
      const std::vector<float> old = values_of(before, i);
      for (std::size_t k = 0; k < ours.size(); ++k) {
        INFO("degree " << degree << ", Gaussian " << i << ", value " << k);
        // Rounding of the parameter at each step, and of the step.
        REQUIRE(std::abs(ours[k] - exact[i][k].p) <=
                kSteps * (6e-8 * (std::abs(exact[i][k].p) + std::abs(old[k])) + 1e-5 * rate_of(k)));
        REQUIRE(ours[k] != old[k]);
      }
    }
  }
}

TEST_CASE("Adam stays finite where gradients are none, tiny or huge") {
  for (const float size : {0.0F, 1e-40F, 1e-22F, 1e-10F, 1e15F}) {
    GaussianCloud cloud = start(1);
    const GaussianCloud before = cloud;
    Adam adam(cloud);
    CloudGradient gradient = gradient_of_step(0, 1);
    for (auto& v : gradient.parameters.means) v = glm::vec3(size);
    for (int step = 0; step < 3; ++step) adam.step(gradient, kRates, cloud);
    for (const std::uint32_t i : gradient.indices) {
      INFO(size);
      const float moved = std::abs(cloud.means[i].x - before.means[i].x);
      REQUIRE(std::isfinite(cloud.means[i].x));
      // Float's least square: below it the second moment is 0, the first is not.
      if (size >= 1e-10F) REQUIRE(moved == Approx(3 * kRates.mean).epsilon(0.01));
      if (size == 0) REQUIRE(moved == 0);
    }
  }
}

TEST_CASE("Adam's moments follow their Gaussians") {
  GaussianCloud cloud = start(2);
  Adam adam(cloud);
  for (unsigned step = 0; step < 4; ++step) adam.step(gradient_of_step(step, 2), kRates, cloud);
  const AdamMoments before = adam.moments();
  std::vector<std::uint32_t> from;
  for (std::uint32_t i = 0; i < kGaussians; i += 2) from.push_back(i);
  from.insert(from.begin() + 5, Adam::kNew);
  from.push_back(3);
  adam.rearrange(from);
  const AdamMoments& after = adam.moments();
  REQUIRE(after.updates.size() == from.size());
  REQUIRE(after.values.size() == from.size() * 2 * after.row);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const bool is_new = from[i] == Adam::kNew;
    CHECK(after.updates[i] == (is_new ? 0 : before.updates[from[i]]));
    for (std::size_t k = 0; k < 2 * after.row; ++k) {
      const float expected = is_new ? 0 : before.values[from[i] * 2 * after.row + k];
      REQUIRE(after.values[i * 2 * after.row + k] == expected);
    }
  }
}

GaussianCloud of_degree(const GaussianCloud& cloud, int degree) {
  GaussianCloud out = cloud;
  const auto from = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  const auto to = static_cast<std::size_t>(sh_coeff_count(degree));
  out.sh_degree = degree;
  out.sh_coeffs.assign(cloud.size() * to, glm::vec3(0));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < from; ++c) {
      out.sh_coeffs[i * to + c] = cloud.sh_coeffs[i * from + c];
    }
  }
  return out;
}

TEST_CASE("Adam of a raised degree is that of the degree with coefficients of no gradient") {
  GaussianCloud raised = start(1);
  GaussianCloud whole = of_degree(raised, 3);
  Adam of_raised(raised), of_whole(whole);
  for (unsigned step = 0; step < 4; ++step) {
    CloudGradient gradient = gradient_of_step(step, 1);
    of_raised.step(gradient, kRates, raised);
    gradient.parameters = of_degree(gradient.parameters, 3);
    of_whole.step(gradient, kRates, whole);
  }
  raised = of_degree(raised, 3);
  of_raised.raise_degree(3);
  for (unsigned step = 4; step < 8; ++step) {
    of_raised.step(gradient_of_step(step, 3), kRates, raised);
    of_whole.step(gradient_of_step(step, 3), kRates, whole);
  }
  for (std::size_t i = 0; i < kGaussians; ++i) {
    REQUIRE(values_of(raised, i) == values_of(whole, i));
  }
  CHECK(of_raised.moments().values == of_whole.moments().values);
}

TEST_CASE("Adam refuses a cloud that changed without its moments") {
  GaussianCloud cloud = start(1);
  Adam adam(cloud);
  CloudGradient gradient = gradient_of_step(0, 1);
  CHECK_THROWS_AS(adam.step(gradient_of_step(0, 2), kRates, cloud), std::logic_error);
  GaussianCloud other = of_degree(cloud, 2);
  CHECK_THROWS_AS(adam.step(gradient_of_step(0, 2), kRates, other), std::logic_error);
  cloud.resize(kGaussians + 1, 1);
  CHECK_THROWS_AS(adam.step(gradient, kRates, cloud), std::logic_error);
}

TEST_CASE("Adam leaves a Gaussian where it is that would leave the limits, and says which") {
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    GaussianCloud cloud = start(1);
    const CloudGradient gradient = gradient_of_step(0, 1);
    const std::uint32_t at = gradient.indices[gradient.size() / 2];
    cloud.log_scales[at].y = 15.9F;
    GaussianCloud moved = cloud;
    LearningRates rates = kRates;
    Adam adam(cloud);
    REQUIRE_FALSE(adam.step(gradient, rates, moved));
    rates.log_scale = 1;
    CloudGradient grows = gradient;
    for (glm::vec3& by : grows.parameters.log_scales) by.y = -1;
    moved = cloud;
    Adam fresh(cloud);
    const auto beyond = fresh.step(grows, rates, moved);
    REQUIRE(beyond);
    CHECK(*beyond == at);
    CHECK(values_of(moved, at) == values_of(cloud, at));
    for (const std::uint32_t other : gradient.indices) {
      if (other != at) CHECK(moved.log_scales[other].y > cloud.log_scales[other].y);
    }
  }
}

TEST_CASE("learning rates follow their schedule") {
  const LearningSchedule schedule;
  struct Row {
    int step;
    double mean;  // parts of the extent
  };
  // Half way of an exponential: the geometric mean.
  for (const Row& row :
       {Row{0, 1.6e-4}, Row{15'000, 1.6e-5}, Row{30'000, 1.6e-6}, Row{40'000, 1.6e-6}}) {
    const LearningRates rates = schedule.at(row.step, 2.5);
    CHECK(rates.mean == Approx(2.5 * row.mean).epsilon(1e-12));
    CHECK(rates.sh_dc == 20 * rates.sh_rest);
  }
  std::vector<Camera> cameras(3);
  cameras[0].position = {0, 0, 0};
  cameras[1].position = {6, 0, 0};
  cameras[2].position = {0, 3, 0};  // mean (2, 1, 0)
  CHECK(scene_extent(cameras) == Approx(1.1 * std::sqrt(17.0)));
}

}  // namespace
}  // namespace sgs::test
