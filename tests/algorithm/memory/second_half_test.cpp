// Encodings of second halves: sizes, layouts by hand, what comes back and how far off it is.
#include "algorithm/memory/second_half.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/splat/random_gaussian.h"
#include "tests/support/uniform.h"

namespace sgs {
namespace {

using test::uniform;
using Encoding = SecondHalfEncoding;

constexpr std::array<std::uint32_t, kCodebookCount> kPaperEntries = {4096, 4096, 4096, 512};
constexpr std::array<std::uint32_t, kCodebookCount> kPaperEntriesDegree0 = {4096, 4096, 4096, 0};

TEST_CASE("second half: bytes of a record by encoding and degree") {
  const std::uint32_t raw[] = {40, 76, 136, 220};
  for (int degree = 0; degree <= 3; ++degree) {
    CHECK(SecondHalfFormat{Encoding::kRaw, degree, {}}.bytes() == raw[degree]);
    CHECK(SecondHalfFormat{Encoding::kHalf, degree, {}}.bytes() == raw[degree] / 2);
  }
  CHECK(SecondHalfFormat{Encoding::kVq, 3, kPaperEntries}.bytes() == 17);
  CHECK(SecondHalfFormat{Encoding::kVq, 0, kPaperEntriesDegree0}.bytes() == 13);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, kPaperEntries}.bytes() == 8);         // 8 + 45 bit
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 0, kPaperEntriesDegree0}.bytes() == 8);  // 8 + 36 bit
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {16, 16, 16, 16}}.bytes() == 4);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {16, 4, 4, 1}}.bytes() == 2);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {65536, 65536, 65536, 256}}.bytes() == 8);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {65536, 65536, 65536, 257}}.bytes() == 16);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {65536, 65536, 65536, 65536}}.bytes() == 16);
  // One entry each: nothing to tell apart.
  CHECK(SecondHalfFormat{Encoding::kVq, 3, {1, 1, 1, 1}}.bytes() == 1);
  CHECK(SecondHalfFormat{Encoding::kVqPacked, 3, {1, 1, 1, 1}}.bytes() == 1);
  CHECK(SecondHalfFormat{Encoding::kVq, 3, {1, 7, 1, 1}}.bytes() == 5);
}

TEST_CASE("second half: codebooks of the paper's sizes take 250 KiB, without SH 160 KiB") {
  const SecondHalfFormat paper{Encoding::kVq, 3, kPaperEntries};
  CHECK(paper.codebook_bytes() == 256000);
  CHECK(SecondHalfFormat{Encoding::kVq, 0, kPaperEntriesDegree0}.codebook_bytes() == 160 * 1024);
  CHECK(SecondHalfFormat{Encoding::kRaw, 3, {}}.codebook_bytes() == 0);

  // Entries lie behind each other, no byte twice, none left out.
  const SecondHalfFormat format{Encoding::kVqPacked, 2, {3, 5, 1, 7}};
  std::uint32_t end = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    for (std::uint32_t index = 0; index < format.entries[id]; ++index) {
      const EntryRange range = format.entry(codebook, index);
      CHECK(range.begin == end);
      CHECK(range.bytes == 4 * codebook_words(codebook, 2));
      end += range.bytes;
    }
  }
  CHECK(end == format.codebook_bytes());
}

TEST_CASE("second half: indices of any number of entries come back") {
  std::mt19937_64 random(1);
  for (const Encoding encoding : {Encoding::kVq, Encoding::kVqPacked}) {
    for (int k = 0; k < 3000; ++k) {
      SecondHalfFormat format{encoding, 3, {}};
      CodebookIndices indices{};
      for (std::size_t id = 0; id < kCodebookCount; ++id) {
        const std::uint64_t below = std::uint64_t{1} << random() % 17;
        format.entries[id] = static_cast<std::uint32_t>(1 + random() % below);
        indices[id] = static_cast<std::uint32_t>(random() % 3 == 0 ? format.entries[id] - 1
                                                                   : random() % format.entries[id]);
      }
      const auto opacity = static_cast<std::uint8_t>(random() % 256);
      std::vector<std::byte> record(format.bytes() + 1, std::byte{0xa5});
      encode_quantised_second_half(format, indices, opacity, record.data());
      REQUIRE(decode_indices(format, record.data()) == indices);
      REQUIRE(record[encoding == Encoding::kVq ? format.bytes() - 1 : 0] == std::byte{opacity});
      REQUIRE(record.back() == std::byte{0xa5});  // nothing behind the record
    }
  }
}

// A Gaussian and its SH through both halves of one encoding.
DecodedGaussian through_half(const Gaussian<float>& g, const glm::vec3* sh, int degree) {
  const SecondHalfFormat format{Encoding::kHalf, degree, {}};
  std::byte first[kFirstHalfBytes], second[kMaxSecondHalfBytes];
  encode_first_half(g, first);
  encode_half_second_half(g, sh, degree, second);
  return decode_second_half(format, decode_first_half(first), second, nullptr);
}

// Of rounding to 16 bits: half a unit in the last of 11 places, 2^-25 below the normal numbers.
double half_error(double value) { return std::max(std::abs(value) * 0x1p-11, 0x1p-25); }

Gaussian<float> random_gaussian(std::mt19937_64& random) {
  Gaussian<float> g{};
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    g.mean[k] = uniform(random, -1e6F, 1e6F);
    g.scale[k] = std::exp(uniform(random, -20, 10));
  }
  for (float& component : g.quat) {
    component = uniform(random, -1, 1);
    squared += static_cast<double>(component) * component;
  }
  for (float& component : g.quat) component = static_cast<float>(component / std::sqrt(squared));
  g.opacity = uniform(random, 0, 1);
  return g;
}

double length(const std::array<float, 4>& quat) {
  double squared = 0;
  for (const float component : quat) squared += static_cast<double>(component) * component;
  return std::sqrt(squared);
}

TEST_CASE("second half: quantised records by hand") {
  std::byte record[17];
  encode_quantised_second_half({Encoding::kVq, 3, kPaperEntries}, {1, 0x203, 4095, 511}, 254,
                               record);
  const unsigned char words[17] = {1, 0, 0, 0, 3, 2, 0, 0, 0xff, 0x0f, 0, 0, 0xff, 1, 0, 0, 254};
  CHECK(std::memcmp(record, words, 17) == 0);
  encode_quantised_second_half({Encoding::kVqPacked, 3, kPaperEntries}, {1, 0x203, 4095, 511}, 254,
                               record);
  // 9 + 12 + 12 + 12 bits: 1ff fff 203 001
  const unsigned char packed[8] = {254, 0x01, 0x30, 0x20, 0xff, 0xff, 0x1f, 0};
  CHECK(std::memcmp(record, packed, 8) == 0);
}

TEST_CASE("half: every field off by no more than sixteen bits leave") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 4000; ++i) {
    const int degree = i % 4;
    const Gaussian<float> g = random_gaussian(random);
    std::vector<glm::vec3> sh(static_cast<std::size_t>(sh_coeff_count(degree)));
    for (glm::vec3& coeff : sh) {
      for (int k = 0; k < 3; ++k) coeff[k] = std::exp(uniform(random, -12, 11)) - 1;
    }
    const DecodedGaussian back = through_half(g, sh.data(), degree);
    REQUIRE(back.gaussian.mean == g.mean);
    const int axis = largest_axis(g.scale);
    REQUIRE(back.gaussian.scale[axis] == g.scale[axis]);
    const double largest = g.scale[axis];
    for (int k = 0; k < 3; ++k) {
      REQUIRE(back.gaussian.scale[k] <= g.scale[axis]);
      REQUIRE(std::abs(back.gaussian.scale[k] - static_cast<double>(g.scale[k])) <=
              1.001 * largest * half_error(g.scale[k] / largest) + 1e-44);
    }
    REQUIRE(length(back.gaussian.quat) == Approx(1).epsilon(2.5e-7));
    for (std::size_t k = 0; k < 4; ++k) {
      // Rounded, then scaled by a length that is off by as much.
      REQUIRE(std::abs(back.gaussian.quat[k] - g.quat[k]) <=
              1.01 * half_error(g.quat[k]) + std::abs(g.quat[k]) * 0x1p-11);
    }
    // Below 1/255 nothing is left; there, rounding up may cost a whole unit.
    REQUIRE(std::abs(back.gaussian.opacity - g.opacity) <=
            (g.opacity < 1 / 255.0F ? g.opacity : 2 * half_error(g.opacity)));
    for (std::size_t c = 0; c < sh.size(); ++c) {
      for (int k = 0; k < 3; ++k) {
        REQUIRE(std::abs(back.sh[c][k] - static_cast<double>(sh[c][k])) <= half_error(sh[c][k]));
      }
    }
  }
}

TEST_CASE("half: extremes are the nearest that sixteen bits hold") {
  Gaussian<float> g{{0, 0, 0}, {1e-5F, 1e5F, 1e-38F}, {1, 0, 0, 0}, 1};
  const float huge = 1e30F;
  const glm::vec3 sh(huge, -huge, 1e-30F);
  const DecodedGaussian back = through_half(g, &sh, 0);
  CHECK(back.gaussian.scale == glm::vec3(0, 1e5F, 0));  // 1e-10 of the largest is nothing
  CHECK(back.gaussian.opacity == 1);
  CHECK(back.gaussian.quat == g.quat);
  CHECK(back.sh[0] == glm::vec3(65504, -65504, 0));
}

// Codebooks of random entries in the shape that quantise() makes.
std::vector<float> random_codebooks(std::mt19937_64& random, const SecondHalfFormat& format) {
  std::vector<float> words;
  for (std::uint32_t e = 0; e < format.entries[0]; ++e) {
    const float b = uniform(random, 0, 1);
    words.insert(words.end(), {1, b, random() % 4 == 0 ? 1e-10F : b * uniform(random, 0, 1)});
  }
  for (std::uint32_t e = 0; e < format.entries[1]; ++e) {
    const Gaussian<float> g = random_gaussian(random);
    words.insert(words.end(), g.quat.begin(), g.quat.end());
  }
  const std::uint32_t colours =
      format.codebook_bytes() / 4 - static_cast<std::uint32_t>(words.size());
  for (std::uint32_t w = 0; w < colours; ++w) words.push_back(uniform(random, -3, 3));
  return words;
}

TEST_CASE("quantised: entries of the indices, scales times the first half's, opacity over 255") {
  std::mt19937_64 random(3);
  for (int k = 0; k < 400; ++k) {
    const int degree = k % 4;
    SecondHalfFormat format{k % 8 < 4 ? Encoding::kVq : Encoding::kVqPacked, degree, {}};
    CodebookIndices at{};
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      if (degree == 0 && id == 3) continue;
      format.entries[id] = 1 + static_cast<std::uint32_t>(random() % 40);
      at[id] = static_cast<std::uint32_t>(random() % format.entries[id]);
    }
    const std::vector<float> words = random_codebooks(random, format);
    std::vector<std::byte> record(format.bytes());
    const auto opacity = static_cast<std::uint8_t>(random() % 256);
    encode_quantised_second_half(format, at, opacity, record.data());
    const FirstHalf first{{1, 2, 3}, uniform(random, 0, 10)};
    const DecodedGaussian back = decode_second_half(
        format, first, record.data(), reinterpret_cast<const std::byte*>(words.data()));
    // Where each codebook begins, in words.
    const std::uint32_t rotations = 3 * format.entries[0];
    const std::uint32_t dcs = rotations + 4 * format.entries[1], shs = dcs + 3 * format.entries[2];
    const auto sh_words = static_cast<std::uint32_t>(3 * (sh_coeff_count(degree) - 1));
    CHECK(back.gaussian.mean == first.mean);
    CHECK(back.gaussian.scale[0] == first.scale_max);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      CHECK(back.gaussian.scale[static_cast<int>(axis)] ==
            first.scale_max * words[3 * at[0] + axis]);
    }
    for (std::uint32_t c = 0; c < 4; ++c) {
      CHECK(back.gaussian.quat[c] == words[rotations + 4 * at[1] + c]);
    }
    for (std::uint32_t c = 0; c < 3; ++c) {
      CHECK(back.sh[0][static_cast<int>(c)] == words[dcs + 3 * at[2] + c]);
    }
    for (std::uint32_t w = 0; w < sh_words; ++w) {
      CHECK(back.sh[1 + w / 3][static_cast<int>(w % 3)] == words[shs + sh_words * at[3] + w]);
    }
    CHECK(back.gaussian.opacity == static_cast<float>(opacity) / 255.0F);
  }
}

TEST_CASE("second half: what can be seen stays so, what cannot be seen does not appear") {
  std::vector<float> opacities = {0, 1e-30F, 0.001F, 0.0039F, 0.004F, 0.5F, 0.99F, 0.9999F, 1};
  float near = 1 / 255.0F;
  for (int k = 0; k < 2000; ++k) near = std::nextafter(near, 0.0F);
  for (int k = 0; k < 4000; ++k) opacities.push_back(near = std::nextafter(near, 1.0F));
  const glm::vec3 sh(0.0F);
  for (const float opacity : opacities) {
    const Gaussian<float> g{{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}, opacity};
    const float half = through_half(g, &sh, 0).gaussian.opacity;
    REQUIRE((half >= 1 / 255.0F) == (opacity >= 1 / 255.0F));
    if (opacity < 1 / 255.0F) REQUIRE(half == 0);
  }
  // 8-bit codes (codebooks.h makes them): 0 is nothing, 1 and more can be seen.
  const SecondHalfFormat format{Encoding::kVq, 0, {1, 1, 1, 0}};
  const std::vector<float> words = {1, 1, 1, 1, 0, 0, 0, 0, 0, 0};
  for (int code = 0; code < 256; ++code) {
    std::byte record[1];
    encode_quantised_second_half(format, {}, static_cast<std::uint8_t>(code), record);
    const DecodedGaussian back = decode_second_half(
        format, {{0, 0, 0}, 1}, record, reinterpret_cast<const std::byte*>(words.data()));
    CHECK((back.gaussian.opacity >= 1 / 255.0F) == (code > 0));
    CHECK(back.gaussian.opacity <= 1);
  }
}

// Whatever the fine filter makes of a decoded Gaussian, the coarse filter let it through.
TEST_CASE("second half: the coarse filter stays conservative on what is decoded") {
  test::RandomGaussians random(4, 320, 200);
  std::mt19937_64 more(4);
  const SecondHalfFormat vq{Encoding::kVq, 0, {200, 200, 1, 0}};
  const std::vector<float> words = random_codebooks(more, vq);
  const glm::vec3 sh(0.3F);
  int reached = 0, missed = 0;
  for (int k = 0; k < 40; ++k) {
    const Camera camera = random.camera();
    const View<float> view = make_view<float>(camera);
    for (int i = 0; i < 1000; ++i) {
      const Gaussian<float> g = random.gaussian(camera);
      std::byte first_bytes[kFirstHalfBytes], record[kMaxSecondHalfBytes];
      encode_first_half(g, first_bytes);
      const FirstHalf first = decode_first_half(first_bytes);
      encode_quantised_second_half(
          vq, {static_cast<std::uint32_t>(more() % 200), static_cast<std::uint32_t>(more() % 200)},
          static_cast<std::uint8_t>(more() % 256), record);
      const CoarseBound bound = coarse_bound(view, first.mean, first.scale_max);
      for (const DecodedGaussian& decoded :
           {through_half(g, &sh, 0),
            decode_second_half(vq, first, record,
                               reinterpret_cast<const std::byte*>(words.data()))}) {
        Splat splat{};
        if (!make_geometry(view, decoded.gaussian, splat)) continue;
        const int x = random.pick(20) * 16, y = random.pick(12) * 16;
        const PixelRect group{x, y, x + 16, y + 16};
        if (!reaches_group(splat, group)) continue;
        ++reached;
        missed += bound.in_front && touches(bound, group) ? 0 : 1;
      }
    }
  }
  CHECK(reached > 5000);
  CHECK(missed == 0);
}

}  // namespace
}  // namespace sgs
