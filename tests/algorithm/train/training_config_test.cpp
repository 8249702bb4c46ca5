// Schedules by the step.
#include "algorithm/train/training_config.h"

#include <catch2/catch.hpp>
#include <cmath>

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

}  // namespace
}  // namespace sgs::test
