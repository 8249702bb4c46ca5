// Numbers follow from their names alone, and are distributed as they should be.
#include "algorithm/train/counter_random.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <set>

namespace sgs::test {
namespace {

TEST_CASE("random: the same names draw the same, others something else") {
  const auto first = [](std::uint64_t seed, RandomUse use, std::uint64_t step,
                        std::uint64_t index) {
    return CounterRandom(seed, use, step, index).bits();
  };
  CHECK(first(1, RandomUse::kNoise, 2, 3) == first(1, RandomUse::kNoise, 2, 3));
  std::set<std::uint64_t> seen;
  for (std::uint64_t a = 0; a < 10; ++a) {
    for (std::uint64_t b = 0; b < 10; ++b) {
      for (std::uint64_t c = 0; c < 10; ++c) {
        seen.insert(first(a, RandomUse::kNoise, b, c));
        seen.insert(first(a, RandomUse::kStart, b, c));
      }
    }
  }
  CHECK(seen.size() == 2000);
}

TEST_CASE("random: mean, deviation and ends of what is drawn") {
  constexpr int kDraws = 100'000;
  double sum = 0, normal_sum = 0, squares = 0, product = 0;
  for (int i = 0; i < kDraws; ++i) {
    CounterRandom random(7, RandomUse::kGrow, 0, static_cast<std::uint64_t>(i));
    const double u = random.uniform();
    REQUIRE(u >= 0);
    REQUIRE(u < 1);
    sum += u;
    const glm::dvec3 n = random.normal3();
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::isfinite(n[k]));
      normal_sum += n[k];
      squares += n[k] * n[k];
    }
    product += n.x * n.y + n.x * n.z + n.y * n.z;
  }
  // Six deviations of each mean.
  CHECK(std::abs(sum / kDraws - 0.5) < 6 * 0.289 / std::sqrt(kDraws));
  CHECK(std::abs(normal_sum / (3.0 * kDraws)) < 6 / std::sqrt(3.0 * kDraws));
  CHECK(std::abs(squares / (3.0 * kDraws) - 1) < 6 * std::sqrt(2 / (3.0 * kDraws)));
  CHECK(std::abs(product / (3.0 * kDraws)) < 6 / std::sqrt(3.0 * kDraws));
}

TEST_CASE("random: below() reaches every number and no other") {
  CounterRandom random(1, RandomUse::kOrderOfViews);
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.below(7));
  CHECK(seen == std::set<std::uint64_t>{0, 1, 2, 3, 4, 5, 6});
}

}  // namespace
}  // namespace sgs::test
