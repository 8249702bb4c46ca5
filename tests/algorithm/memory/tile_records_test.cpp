// Records of projected Gaussians: what halves leave of a conic.
#include "algorithm/memory/tile_records.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>

namespace sgs {
namespace {

constexpr double kHalfRounding = 0x1p-11;

struct Row {
  const char* which;
  float conic_a, conic_b, conic_c;
};

Splat splat_of(const Row& row) {
  Splat s{};
  s.x = 1000.3F;
  s.y = 2.7F;
  s.conic_a = row.conic_a;
  s.conic_b = row.conic_b;
  s.conic_c = row.conic_c;
  s.opacity = 0.75F;
  s.rgb = {0.5F, 0.25F, 1};
  return s;
}

// |A|, B/A and C - B^2/A to the last place of a half: far out on a needle C - B^2/A is 10^-6 of C.
TEST_CASE("record in halves: the square is completed before it is rounded") {
  for (const Row& row :
       {Row{"round", 1, 0, 1}, Row{"leaning", 0.03F, 0.01F, 0.05F},
        Row{"a needle at 45 degrees", 1.6F, -1.599999F, 1.6F},
        Row{"a needle along x", 1e-7F, 3e-4F, 3}, Row{"a needle along y", 3, 3e-4F, 1e-7F},
        Row{"10,000 px wide", 1e-8F, 2e-9F, 1e-8F}}) {
    CAPTURE(row.which);
    const Splat s = splat_of(row);
    std::byte bytes[record_bytes(NumberFormat::kHalf)];
    encode_projected(NumberFormat::kHalf, s, bytes);
    const SquareSplat got = decode_square(NumberFormat::kHalf, bytes, 0);
    const SquareConic<float> expected = square_conic(s.conic_a, s.conic_b, s.conic_c);
    CHECK(got.conic.a == Approx(expected.a).epsilon(kHalfRounding));
    CHECK(got.conic.lean == Approx(expected.lean).epsilon(kHalfRounding));
    CHECK(got.conic.rest == Approx(expected.rest).epsilon(kHalfRounding));
    CHECK(got.x == s.x);
    CHECK(got.y == s.y);
    CHECK(got.opacity == s.opacity);
    CHECK(got.rgb == s.rgb);
  }
}

TEST_CASE("record in halves: blending in single gets its terms back") {
  const Splat s = splat_of({"leaning", 0.03F, 0.01F, 0.05F});
  std::byte bytes[record_bytes(NumberFormat::kHalf)];
  encode_projected(NumberFormat::kHalf, s, bytes);
  const Splat got = decode_projected(NumberFormat::kHalf, bytes, 0);
  CHECK(got.conic_a == Approx(s.conic_a).epsilon(kHalfRounding));
  CHECK(got.conic_b == Approx(s.conic_b).epsilon(2 * kHalfRounding));
  CHECK(got.conic_c == Approx(s.conic_c).epsilon(2 * kHalfRounding));
}

Splat through_floats(const Splat& s) {
  std::byte bytes[record_bytes(NumberFormat::kSingle)];
  encode_projected(NumberFormat::kSingle, s, bytes);
  return decode_projected(NumberFormat::kSingle, bytes,
                          listed_opacity(NumberFormat::kSingle, s.opacity));
}

TEST_CASE("record in floats: every bit comes back, the square completed of them") {
  const Splat s = splat_of({"a needle at 45 degrees", 1.6F, -1.599999F, 1.6F});
  const Splat got = through_floats(s);
  CHECK(got.x == s.x);
  CHECK(got.y == s.y);
  CHECK(got.conic_a == s.conic_a);
  CHECK(got.conic_b == s.conic_b);
  CHECK(got.conic_c == s.conic_c);
  CHECK(got.opacity == s.opacity);
  CHECK(got.rgb == s.rgb);
  std::byte bytes[record_bytes(NumberFormat::kSingle)];
  encode_projected(NumberFormat::kSingle, s, bytes);
  const SquareConic<float> square = decode_square(NumberFormat::kSingle, bytes, 0).conic;
  const SquareConic<float> expected = square_conic(s.conic_a, s.conic_b, s.conic_c);
  CHECK(square.a == expected.a);
  CHECK(square.lean == expected.lean);
  CHECK(square.rest == expected.rest);
}

TEST_CASE("record in floats: an opacity that can be seen comes back from its two places") {
  Splat s = splat_of({"round", 1, 0, 1});
  for (const float opacity : {1.0F, 0.99999994F, 0.75F, 0.3F, 0.1234567F, 1.0F / 255, 0x1p-8F}) {
    s.opacity = opacity;
    CHECK(through_floats(s).opacity == opacity);
    CHECK(through_floats(s).conic_a == s.conic_a);
    CHECK(through_floats(s).rgb == s.rgb);
  }
  for (const float unseen : {0.0F, 1e-30F, 0.003F}) {
    s.opacity = unseen;
    CHECK(through_floats(s).opacity == 0);
  }
}

TEST_CASE("entry of a list: the number's highest bit stands where a depth has no sign") {
  for (const NumberFormat keys : {NumberFormat::kHalf, NumberFormat::kSingle}) {
    for (const NumberFormat features : {NumberFormat::kHalf, NumberFormat::kSingle}) {
      for (const int across : {1, 2, 4}) {
        const EntryFormat format{keys, across, features};
        CAPTURE(format.bytes());
        TileEntry entry;
        entry.key = depth_key(keys, 1000.5F);
        entry.record = static_cast<std::uint32_t>(format.records() - 2);
        entry.bitmap = across == 4 ? 0xa00f : 0xf;
        entry.opacity = listed_opacity(features, 0.7F);
        std::byte bytes[16];
        encode_entry(format, entry, bytes);
        const TileEntry got = decode_entry(format, bytes);
        CHECK(got.key == entry.key);
        CHECK(got.record == entry.record);
        CHECK(got.bitmap == entry.bitmap);
        CHECK(got.opacity == entry.opacity);
      }
    }
  }
}

}  // namespace
}  // namespace sgs
