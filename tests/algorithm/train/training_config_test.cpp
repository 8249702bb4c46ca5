// Schedules by the step.
#include "algorithm/train/training_config.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

namespace sgs::test {
namespace {

TEST_CASE("schedule: pictures grow to their full size, in steps of the square root of 2") {
  TrainingConfig config;
  config.steps = 1000;
  CHECK(config.downscale_at(0) == 4);
  double before = 4;
  for (int step = 0; step < 1000; ++step) {
    const double now = config.downscale_at(step);
    REQUIRE(now <= before);
    const double halvings = 2 * std::log2(now);
    REQUIRE(halvings == Approx(std::round(halvings)).margin(1e-12));
    before = now;
  }
  CHECK(config.downscale_at(250) == 1);
  config.first_downscale = 1;
  CHECK(config.downscale_at(0) == 1);
}

TEST_CASE("schedule: degrees, growth and rates") {
  TrainingConfig config;
  config.steps = 10'000;
  CHECK(config.degree_at(0) == 0);
  CHECK(config.degree_at(499) == 0);
  CHECK(config.degree_at(500) == 1);
  CHECK(config.degree_at(1500) == 3);
  CHECK(config.degree_at(9999) == 3);
  config.sh_degree = 0;
  CHECK(config.degree_at(9999) == 0);

  CHECK_FALSE(config.grows_at(100));
  CHECK(config.grows_at(200));
  CHECK_FALSE(config.grows_at(250));
  CHECK(config.grows_at(8000));
  CHECK_FALSE(config.grows_at(8100));

  CHECK(config.rates_at(0, 2).mean == Approx(2 * 1.6e-4));
  CHECK(config.rates_at(10'000, 2).mean == Approx(2 * 1.6e-6));
}

// 3D Gaussian Splatting as MCMC (Kheradmand et al. 2024) and its code: 5 % more each 100 steps,
// noise_lr, opacity_reg, scale_reg.
TEST_CASE("schedule: defaults of MCMC") {
  const TrainingConfig config;
  CHECK(config.growth == Growth::kMcmc);
  CHECK(config.growth_factor == 1.05);
  CHECK(config.grow_every == 100);
  CHECK(config.noise == 5e5);
  CHECK(config.opacity_share == 0.01);
  CHECK(config.scale_share == 0.01);
}

// Arguments of the original's released code (Kerbl et al. 2023): opacity_reset_interval,
// densify_grad_threshold, percent_dense, scaling_lr, rotation_lr, opacity_lr of the first release,
// feature_lr and a 20th of it, position_lr_init, _final and _max_steps.
TEST_CASE("schedule: defaults of the original") {
  const TrainingConfig config;
  CHECK(config.reset_every == 3000);
  CHECK(config.densification.pull == 2e-4);
  CHECK(config.densification.clone_share == 0.01);
  CHECK(config.densification.least_opacity == 0.005);
  CHECK(config.densification.most_scale_share == 0.1);
  CHECK(config.densification.most_radius_px == 20);
  CHECK(config.densification.reset_opacity == 0.01);

  // Positions by the extent, halfway by the geometric mean; the rest does not change.
  const LearningSchedule schedule;
  for (const auto& [step, mean] :
       {std::pair{0, 1.6e-4}, {15'000, 1.6e-5}, {30'000, 1.6e-6}, {40'000, 1.6e-6}}) {
    CAPTURE(step);
    const LearningRates rates = schedule.at(step, 3);
    CHECK(rates.mean == Approx(3 * mean));
    CHECK(rates.log_scale == 5e-3);
    CHECK(rates.quat == 1e-3);
    CHECK(rates.opacity_logit == 0.05);
    CHECK(rates.sh_dc == 2.5e-3);
    CHECK(rates.sh_rest == 2.5e-3 / 20);
  }
}

}  // namespace
}  // namespace sgs::test
