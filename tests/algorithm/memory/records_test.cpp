// Records of Gaussians and splats: what is encoded comes back, to the bit.
#include "algorithm/memory/records.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "algorithm/memory/splat_record.h"

namespace sgs {
namespace {

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void check_round_trip(const Gaussian<float>& g, const std::vector<glm::vec3>& sh, int degree) {
  std::byte first_bytes[kFirstHalfBytes], second_bytes[kMaxSecondHalfBytes];
  encode_first_half(g, first_bytes);
  encode_raw_second_half(g, sh.data(), degree, second_bytes);
  const FirstHalf first = decode_first_half(first_bytes);
  CHECK(same_bits(first.mean, g.mean));
  CHECK(first.scale_max == std::max({g.scale.x, g.scale.y, g.scale.z}));
  const DecodedGaussian back = decode_raw_second_half(first, second_bytes, degree);
  CHECK(same_bits(back.gaussian.mean, g.mean));
  CHECK(same_bits(back.gaussian.scale, g.scale));
  CHECK(same_bits(back.gaussian.quat, g.quat));
  CHECK(same_bits(back.gaussian.opacity, g.opacity));
  CHECK(std::memcmp(back.sh, sh.data(), sh.size() * sizeof(glm::vec3)) == 0);
}

TEST_CASE("records: the largest scale along each axis, equal scales, scales of nought") {
  const std::vector<glm::vec3> sh(1);
  const glm::vec3 scales[] = {{3, 1, 2},        {1, 3, 2}, {1, 2, 3}, {2, 2, 2},
                              {1, 2, 2},        {2, 1, 2}, {2, 2, 1}, {0, 0, 0},
                              {0, 1, 0},        {0, 0, 1}, {1, 0, 0}, {1e-38F, 1e-45F, 3e38F},
                              {3e38F, 0, 3e38F}};
  for (const glm::vec3& scale : scales) {
    INFO(scale.x << " " << scale.y << " " << scale.z);
    check_round_trip({{1, 2, 3}, scale, {1, 0, 0, 0}, 0.5F}, sh, 0);
  }
}

TEST_CASE("records: a first half is x, y, z and the largest scale, little-endian") {
  std::byte bytes[kFirstHalfBytes];
  encode_first_half({{1, -2, 0.5F}, {3, 8, 2}, {1, 0, 0, 0}, 0.5F}, bytes);
  const unsigned char expected[] = {0, 0, 0x80, 0x3f, 0, 0, 0,    0xc0,
                                    0, 0, 0,    0x3f, 0, 0, 0x00, 0x41};
  CHECK(std::memcmp(bytes, expected, sizeof expected) == 0);
}

TEST_CASE("splat record: all but the footprint to the bit, the footprint cut to the group") {
  const SubtileRect group{16, 32, 32, 48};
  Splat splat{};
  splat.x = 70.25F;
  splat.y = -3.5F;
  splat.conic_a = 0.1F;
  splat.conic_b = -0.02F;
  splat.conic_c = std::numeric_limits<float>::denorm_min();
  splat.opacity = 0.99F;
  splat.depth = 12.0F;
  splat.index = 0xdeadbeef;
  splat.rgb = {0.1F, 2.0F, 0};
  const auto through = [&](const SubtileRect& footprint) {
    splat.footprint = footprint;
    std::byte bytes[kSplatEntryBytes];
    encode_splat(splat, group, bytes);
    const Splat back = decode_splat(bytes, group);
    CHECK(std::memcmp(&back, &splat, offsetof(Splat, footprint)) == 0);
    return back.footprint;
  };
  CHECK(through({20, 40, 25, 41}) == SubtileRect{20, 40, 25, 41});
  CHECK(through({0, 0, 500, 500}) == group);
  CHECK(through({0, 40, 18, 500}) == SubtileRect{16, 40, 18, 48});
  CHECK(through({0, 0, 10, 10}).empty());
}

TEST_CASE("splat record: a group of the largest size keeps its far corner") {
  const auto side = static_cast<std::uint16_t>(kMaxGroupPx / 4);
  const SubtileRect group{1000, 2000, static_cast<std::uint16_t>(1000 + side),
                          static_cast<std::uint16_t>(2000 + side)};
  Splat splat{};
  splat.footprint = group;
  std::byte bytes[kSplatEntryBytes];
  encode_splat(splat, group, bytes);
  CHECK(decode_splat(bytes, group).footprint == group);
}

}  // namespace
}  // namespace sgs
