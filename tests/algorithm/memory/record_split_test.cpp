// Records as storage orders divide them: every encoding comes back to the bit.
#include "algorithm/memory/record_split.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "algorithm/memory/records.h"
#include "tests/algorithm/splat/random_gaussian.h"

namespace sgs {
namespace {

using Encoding = SecondHalfEncoding;

Gaussian<float> random_gaussian(std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Gaussian<float> g{};
  double length = 0, quat[4];
  for (double& component : quat) {
    component = uniform(-1, 1) * (random() % 3 == 0 ? 1e-6 : 1);
    length += component * component;
  }
  for (std::size_t k = 0; k < 4; ++k) g.quat[k] = static_cast<float>(quat[k] / std::sqrt(length));
  for (int k = 0; k < 3; ++k) {
    g.mean[k] = static_cast<float>(uniform(-1e6, 1e6));
    g.scale[k] = static_cast<float>(std::exp(uniform(-20, 16.1)));
  }
  g.opacity = random() % 5 == 0 ? 1.0F : static_cast<float>(uniform(0, 1));
  return g;
}

bool same(const DecodedGaussian& a, const DecodedGaussian& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Writes and reads back; the bytes around the records stay as they are.
DecodedGaussian through(const RecordSplit& split, const SecondHalfFormat& format,
                        const Gaussian<float>& g, const std::vector<std::byte>& encoded,
                        const std::byte* codebooks) {
  constexpr std::byte kGuard{0xa5};
  std::vector<std::byte> first(split.first_bytes() + 1, kGuard);
  std::vector<std::byte> second(split.second_bytes + 1, kGuard);
  write_record(split, format, g, encoded.data(), first.data(), second.data());
  CHECK(first.back() == kGuard);
  CHECK(second.back() == kGuard);
  const SplitFirstHalf half = read_first_half(split, first.data());
  CHECK(std::memcmp(&half.mean, &g.mean, sizeof g.mean) == 0);
  const VisibleExtents least = visible_extents(g);
  CHECK(half.extents.scale_max >= least.scale_max);
  if (split.bound_by == CoarseBoundBy::kExtents) {
    for (int a = 0; a < 3; ++a) CHECK(half.extents.extent[a] >= least.extent[a]);
  } else {
    CHECK(half.extents.scale_max == least.scale_max);
  }
  if (format.quantised()) {
    CHECK(read_indices(split, format, half.carried, second.data()) ==
          decode_indices(format, encoded.data()));
  }
  return read_record(split, format, half.mean, half.carried, second.data(), codebooks);
}

TEST_CASE("record split: every encoding and degree comes back as its decoder gives it") {
  std::mt19937 random(3);
  for (int round = 0; round < 4000; ++round) {
    const int degree = round % 4;
    const auto encoding = static_cast<Encoding>(round / 4 % 4);
    SecondHalfFormat format{encoding, degree, {}};
    if (format.quantised()) {
      for (std::size_t id = 0; id < kCodebookCount; ++id) {
        const bool none = codebook_words(static_cast<Codebook>(id), degree) == 0;
        format.entries[id] = none ? 0 : 1U << random() % 10;
      }
    }
    INFO(kEncodingNames[static_cast<std::size_t>(encoding)] << ", degree " << degree);
    std::vector<float> words(format.codebook_bytes() / 4);
    for (float& word : words) word = static_cast<float>(random() % 1000) / 1000;
    const auto* codebooks = reinterpret_cast<const std::byte*>(words.data());
    const Gaussian<float> g = random_gaussian(random);
    glm::vec3 sh[16];
    for (glm::vec3& c : sh) c = {random() % 99, -1.0F * static_cast<float>(random() % 99), 1.5F};
    std::vector<std::byte> encoded(format.bytes());
    if (encoding == Encoding::kRaw) {
      encode_raw_second_half(g, sh, degree, encoded.data());
    } else if (encoding == Encoding::kHalf) {
      encode_half_second_half(g, sh, degree, encoded.data());
    } else {
      CodebookIndices indices{};
      for (std::size_t id = 0; id < kCodebookCount; ++id) {
        if (format.entries[id] > 0)
          indices[id] = static_cast<std::uint32_t>(random() % format.entries[id]);
      }
      encode_quantised_second_half(format, indices, static_cast<std::uint8_t>(random() % 256),
                                   encoded.data());
    }
    const float scale_max = g.scale[largest_axis(g.scale)];
    const DecodedGaussian expected =
        decode_second_half(format, {g.mean, scale_max}, encoded.data(), codebooks);
    REQUIRE(same(through(published_split(format), format, g, encoded, codebooks), expected));
    REQUIRE(same(through(burst_split(format), format, g, encoded, codebooks), expected));
  }
}

TEST_CASE("short quaternion: what was normalised in double comes back to the bit") {
  std::mt19937 random(5);
  for (int round = 0; round < 200'000; ++round) {
    const std::array<float, 4> quat = random_gaussian(random).quat;
    const std::array<float, 4> back = lengthen(shorten(quat));
    REQUIRE(std::memcmp(&quat, &back, sizeof quat) == 0);
  }
  const float half = 0.5F, root = std::sqrt(0.5F);
  for (const std::array<float, 4>& quat : {std::array<float, 4>{1, 0, 0, 0},
                                           {0, -1, 0, -0.0F},
                                           {half, half, half, half},
                                           {-half, half, -half, half},
                                           {0, root, -root, 0},
                                           {root, 0, 0, root}}) {
    const std::array<float, 4> back = lengthen(shorten(quat));
    CHECK(std::memcmp(&quat, &back, sizeof quat) == 0);
  }
}

TEST_CASE("short quaternion: another length is refused") {
  CHECK_THROWS_WITH(shorten({1.0001F, 0, 0, 0}),
                    "quaternion: got (1.0001, 0, 0, 0), expected length 1");
  CHECK_THROWS_AS(shorten({0, 0, 0, 0}), std::invalid_argument);
  CHECK_THROWS_AS(shorten({0.6F, 0.6F, 0.6F, 0.6F}), std::invalid_argument);
}

}  // namespace
}  // namespace sgs
