// Sums in fixed point: by hand at the ends of their range, and in every order.
#include "algorithm/vq/fixed_point_sums.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

using namespace sgs;

namespace {

double sum_of(const std::vector<double>& addends, int fraction_bits) {
  FixedPointSums sums(3, fraction_bits);
  for (const double addend : addends) sums.add(1, addend);
  CHECK(sums[0] == 0);
  CHECK(sums[2] == 0);
  return sums[1];
}

// Numbers of all sizes below `largest` in magnitude, and below its 2^-50th part.
std::vector<double> mixed_numbers(unsigned seed, std::size_t count, double largest) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1), exponent(-50, 0);
  std::vector<double> numbers(count);
  for (double& number : numbers) {
    number = std::ldexp(uniform(random), static_cast<int>(exponent(random))) * largest;
  }
  return numbers;
}

std::vector<double> added_by(std::size_t threads, const std::vector<double>& addends,
                             std::size_t sums_count) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  FixedPointSums sums(sums_count);
  tbb::parallel_for(std::size_t{0}, addends.size(),
                    [&](std::size_t i) { sums.add(i % sums_count, addends[i]); });
  std::vector<double> out;
  for (std::size_t k = 0; k < sums_count; ++k) out.push_back(sums[k]);
  return out;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = 0x1p31 - 0x1p-22;  // of 53 bits below 2^31

}  // namespace

TEST_CASE("fixed-point sums by hand") {
  struct Case {
    const char* what;
    std::vector<double> addends;
    int fraction_bits;
    double expected;
  };
  const std::vector<Case> cases = {
      {"nothing", {}, 32, 0},
      {"one", {0.75}, 32, 0.75},
      {"negative", {-0.75}, 32, -0.75},
      {"both signs", {1.5, -4, 0.25}, 32, -2.25},
      {"down to zero", {3, -3}, 32, 0},
      {"up to zero", {-3, 3}, 32, 0},
      {"through zero and back", {1, -2, 2, -1, -0.5}, 32, -0.5},
      {"the resolution", {0x1p-32, -0x1p-31}, 32, -0x1p-32},
      {"cut toward zero", {0x1.8p-32, 0x1.8p-32}, 32, 0x1p-31},
      {"cut toward zero from below", {-0x1.8p-32, -0x1.8p-32}, 32, -0x1p-31},
      {"below the resolution", {0x1.fp-33, -0x1.fp-33, 1e-300, -1e-300, -0.0}, 32, 0},
      {"the smallest number", {5e-324}, 62, 0},
      {"a finer resolution", {0x1p-62, 0.5}, 62, 0.5 + 0x1p-62},
      {"whole numbers", {0.99, -0.99, 7.5, -0x1p62}, 0, 7 - 0x1p62},
      {"the largest addend", {kLargest}, 32, kLargest},
      {"the least addend", {-kLargest}, 32, -kLargest},
      {"a sum beyond 64 bits", {kLargest, kLargest, kLargest}, 32, 3 * kLargest},
      {"below -2^63 units", {-kLargest, -kLargest, -kLargest}, 32, -3 * kLargest},
      {"beyond 64 bits and back",
       {kLargest, kLargest, kLargest, -kLargest, -kLargest, -kLargest, 0.125},
       32,
       0.125},
      {"rounded once, when read", {0x1p30, 0x1p-32}, 32, 0x1p30},
      {"out of range", {1, 0x1p31}, 32, kNan},
      {"out of range below", {-0x1p31, 1, 1}, 32, kNan},
      {"out of a finer range", {2}, 62, kNan},
      {"infinity", {kInfinity, 1}, 32, kNan},
      {"infinities do not cancel to something", {kInfinity, -kInfinity, -1}, 32, kNan},
      {"not a number", {1, kNan, -1, -1}, 32, kNan},
      {"not a number, then much", {kNan, kLargest, kLargest, kLargest, -kLargest}, 32, kNan},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    std::vector<double> addends = c.addends;
    // Forward, backward and from the middle.
    for (int order = 0; order < 3; ++order) {
      const double sum = sum_of(addends, c.fraction_bits);
      if (std::isnan(c.expected)) {
        CHECK(std::isnan(sum));
      } else {
        CHECK(sum == c.expected);
      }
      if (order == 0) std::reverse(addends.begin(), addends.end());
      if (order == 1) {
        std::rotate(addends.begin(), addends.begin() + (addends.size() + 1) / 2, addends.end());
      }
    }
  }
}

TEST_CASE("fixed-point sums: the same bits in any order and with any number of threads") {
  constexpr std::size_t kSums = 7;
  // Small ones, and so large ones that the sums leave 64 bits again and again.
  for (const double largest : {1.0, 0x1p31}) {
    CAPTURE(largest);
    std::vector<double> addends = mixed_numbers(5, 7000 * kSums, largest);
    const std::vector<double> one = added_by(1, addends, kSums);
    for (const std::size_t threads : {2U, 3U, 8U}) {
      CHECK(same_bits(added_by(threads, addends, kSums), one));
    }
    // Reversed as a whole, each addend still falls to the sum that it fell to.
    std::reverse(addends.begin(), addends.end());
    std::vector<double> mirrored = added_by(4, addends, kSums);
    std::reverse(mirrored.begin(), mirrored.end());
    CHECK(same_bits(mirrored, one));
    CHECK(std::none_of(one.begin(), one.end(), [](double sum) { return sum == 0; }));
  }
}
