// The sequence of splats of blend_pass.h.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "algorithm/render/blend_pass.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/render/test_clouds.h"

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

TEST_CASE("a sequence gives every visible splat once, in order, in batches of any size") {
  // Half of the cloud is behind the camera or beside the frame.
  const ActivatedCloud cloud = activate(test::random_cloud(4, 20000, 2, {0, 0, 1}, 6, 0.01F, 0.3F));
  const auto view = make_view<float>(test::forward_camera(120, 70, 100));
  std::vector<Splat> expected;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    Splat splat{};
    if (!make_geometry(view, cloud.gaussians[i], splat)) continue;
    splat.index = i;
    add_colour(view, cloud.sh_degree, cloud.gaussians[i].mean, cloud.sh(i), splat);
    expected.push_back(splat);
  }
  std::sort(expected.begin(), expected.end(), in_front);
  REQUIRE(expected.size() > 1000);
  REQUIRE(expected.size() < 15000);
  for (const std::size_t most : {std::size_t{1000}, std::size_t{7777}, std::size_t{1} << 20}) {
    SplatSequence sequence(view, cloud);
    std::vector<Splat> all, batch;
    while (!sequence.at_end()) {
      sequence.next(most, batch);
      REQUIRE(batch.size() <= most);
      all.insert(all.end(), batch.begin(), batch.end());
    }
    REQUIRE(all.size() == expected.size());
    CHECK(std::memcmp(all.data(), expected.data(), all.size() * sizeof(Splat)) == 0);
  }
}
