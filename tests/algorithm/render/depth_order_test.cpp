// Tests of algorithm/render/depth_order.h.
#include "algorithm/render/depth_order.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace sgs;

namespace {

void check_sorted(std::vector<DepthKey> keys) {
  auto expected = keys;
  std::sort(expected.begin(), expected.end(), [](const DepthKey& a, const DepthKey& b) {
    return a.depth_bits < b.depth_bits || (a.depth_bits == b.depth_bits && a.index < b.index);
  });
  sort_front_to_back(keys);
  CHECK(std::equal(keys.begin(), keys.end(), expected.begin(), expected.end(),
                   [](const DepthKey& a, const DepthKey& b) {
                     return a.depth_bits == b.depth_bits && a.index == b.index;
                   }));
}

}  // namespace

TEST_CASE("depths of every size sort by (depth, index), many of them equal") {
  std::mt19937 random(1);
  for (const std::uint32_t count : {0U, 1U, 2U, 1000U, 65536U, 65537U, 300000U}) {
    std::vector<DepthKey> keys;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float depth = std::exp(std::uniform_real_distribution<float>(-1.6F, 80)(random));
      const float chosen = i % 3 == 0 ? 2.5F : depth;
      keys.push_back({__builtin_bit_cast(std::uint32_t, chosen), i});
    }
    CAPTURE(count);
    check_sorted(keys);
  }
}
