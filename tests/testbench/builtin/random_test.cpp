// random.h against published values, and the statistics of what is built on it.
#include "testbench/builtin/random.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "testbench/builtin/noise.h"

using namespace sgs;

TEST_CASE("random: SplitMix64's reference sequence") {
  // The first outputs for seed 1234567 in the published test of the reference code.
  std::uint64_t state = 1234567;
  const auto next = [&state] {
    const std::uint64_t value = mix_bits(state);
    state += 0x9e3779b97f4a7c15u;
    return value;
  };
  CHECK(next() == 6457827717110365317u);
  CHECK(next() == 3203168211198807973u);
  CHECK(next() == 9817491932198370423u);
}

TEST_CASE("random: moments of the distributions") {
  Random random(1);
  constexpr int kCount = 200'000;
  double uniform = 0, normal = 0, square = 0, least = 1, most = 0;
  glm::dvec3 direction(0.0);
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform(), g = random.normal();
    least = std::min(least, u);
    most = std::max(most, u);
    uniform += u / kCount;
    normal += g / kCount;
    square += g * g / kCount;
    const glm::dvec3 d = random.direction();
    REQUIRE(glm::length(d) == Approx(1.0));
    direction += d / static_cast<double>(kCount);
  }
  // Five standard errors.
  CHECK(uniform == Approx(0.5).margin(5 * 0.2887 / 447));
  CHECK(normal == Approx(0.0).margin(5.0 / 447));
  CHECK(square == Approx(1.0).margin(5 * 1.4142 / 447));
  CHECK(glm::length(direction) < 5.0 / 447);
  CHECK(least >= 0.0);
  CHECK(most < 1.0);
}

TEST_CASE("random: even points fill every cell of a grid") {
  constexpr int kSide = 20, kPoints = 4 * kSide * kSide;
  std::vector<int> hits(kSide * kSide, 0);
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec2 p = even_point(static_cast<std::uint64_t>(i));
    ++hits[static_cast<int>(p.y * kSide) * kSide + static_cast<int>(p.x * kSide)];
  }
  // Independent points would leave 1.8 % of the cells empty.
  CHECK(*std::min_element(hits.begin(), hits.end()) >= 1);
  CHECK(*std::max_element(hits.begin(), hits.end()) <= 8);
}

TEST_CASE("noise: smooth, bounded, and smooth step's ends") {
  for (int i = -300; i < 300; ++i) {
    const glm::dvec3 p(0.37 * i, -0.11 * i, 0.05 * i);
    const double value = fractal_noise(p, 4);
    REQUIRE(value >= 0.0);
    REQUIRE(value <= 1.0);
    REQUIRE(std::abs(fractal_noise(p + 1e-6, 4) - value) < 1e-4);
  }
  CHECK(smooth_step(1, 3, 0.5) == 0.0);
  CHECK(smooth_step(1, 3, 2.0) == 0.5);
  CHECK(smooth_step(1, 3, 9.0) == 1.0);
  CHECK(smooth_step(3, 1, 2.5) == Approx(smooth_step(1, 3, 1.5)));
}
