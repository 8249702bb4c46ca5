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
    encode_splat(NumberFormat::kSingle, splat, group, bytes);
    const Splat back = decode_splat(NumberFormat::kSingle, bytes, group);
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
  for (const NumberFormat format : {NumberFormat::kSingle, NumberFormat::kHalf}) {
    std::byte bytes[kSplatEntryBytes];
    encode_splat(format, splat, group, bytes);
    CHECK(decode_splat(format, bytes, group).footprint == group);
  }
}

TEST_CASE("splat record: in halves the key and the centre to the bit, the rest to 11 bits") {
  const SubtileRect group{16, 32, 32, 48};
  Splat splat{};
  splat.x = 70.2503F;
  splat.y = -3.5007F;
  splat.conic_a = 0.1F;
  splat.conic_b = -0.02F;
  splat.conic_c = 0.013F;
  splat.opacity = 0.987F;
  splat.depth = 12.3456789F;
  splat.index = 0xdeadbeef;
  splat.rgb = {0.1F, 2.01F, 0};
  splat.footprint = {20, 40, 25, 41};
  std::byte bytes[splat_entry_bytes(NumberFormat::kHalf)];
  encode_splat(NumberFormat::kHalf, splat, group, bytes);
  const Splat back = decode_splat(NumberFormat::kHalf, bytes, group);
  CHECK(back.x == splat.x);
  CHECK(back.y == splat.y);
  CHECK(back.depth == splat.depth);
  CHECK(back.index == splat.index);
  CHECK(back.footprint == splat.footprint);
  CHECK(back.opacity != splat.opacity);
  constexpr double kHalfPlace = 0x1p-11;
  const auto near = [](float value, double places) {
    return Approx(static_cast<double>(value)).epsilon(places * kHalfPlace);
  };
  CHECK(back.opacity == near(splat.opacity, 1));
  CHECK(back.rgb.x == near(splat.rgb.x, 1));
  CHECK(back.rgb.y == near(splat.rgb.y, 1));
  CHECK(back.rgb.z == 0);
  CHECK(back.conic_a == near(splat.conic_a, 1));
  CHECK(back.conic_b == near(splat.conic_b, 2));
  CHECK(back.conic_c == near(splat.conic_c, 4));
  const Splat rounded = rounded_splat(NumberFormat::kHalf, splat);
  CHECK(std::memcmp(&back, &rounded, offsetof(Splat, footprint)) == 0);
  CHECK(rounded.footprint == splat.footprint);
}

}  // namespace
}  // namespace sgs
