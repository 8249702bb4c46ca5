// Codebooks as they lie in memory (StreamingGS, DAC 2025: vector quantisation): quantised second
// halves point into them. Their making: algorithm/vq.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sgs {

enum class Codebook : std::uint8_t { kScale, kRotation, kDc, kSh };
constexpr std::size_t kCodebookCount = 4;
constexpr std::array<const char*, kCodebookCount> kCodebookNames = {"scale", "rotation", "dc",
                                                                    "sh"};

constexpr std::uint32_t kMaxCodebookEntries = 1U << 16;

// Words (floats) of an entry. Scale: ratios to the largest, falling, the first 1. Rotation: unit
// quaternion (w, x, y, z). DC: rgb. SH: the higher bands, rgb each; none at degree 0.
constexpr std::uint32_t codebook_words(Codebook codebook, int sh_degree) {
  switch (codebook) {
    case Codebook::kScale:
      return 3;
    case Codebook::kRotation:
      return 4;
    case Codebook::kDc:
      return 3;
    default:
      return 3 * static_cast<std::uint32_t>((sh_degree + 1) * (sh_degree + 1) - 1);
  }
}

// An entry of each codebook.
using CodebookIndices = std::array<std::uint32_t, kCodebookCount>;

// How the codebooks of a scene are made.
struct VqConfig {
  std::uint32_t scale_entries = 4096;
  std::uint32_t rotation_entries = 4096;
  std::uint32_t dc_entries = 4096;
  std::uint32_t sh_entries = 512;
  std::uint32_t iterations = 20;
  std::uint64_t seed = 1;

  std::uint32_t entries(Codebook codebook) const {
    const std::uint32_t all[kCodebookCount] = {scale_entries, rotation_entries, dc_entries,
                                               sh_entries};
    return all[static_cast<std::size_t>(codebook)];
  }
};

// Its keys, for a visitor as modules/config has.
template <class Visitor>
void visit(Visitor& v, VqConfig& c) {
  constexpr std::uint32_t kMost = kMaxCodebookEntries;
  v("scale_entries", c.scale_entries, {1, kMost}, "most entries of the scale codebook");
  v("rotation_entries", c.rotation_entries, {1, kMost}, "of the rotation codebook");
  v("dc_entries", c.dc_entries, {1, kMost}, "of the codebook of base colours");
  v("sh_entries", c.sh_entries, {1, kMost}, "of the codebook of the higher bands");
  v("iterations", c.iterations, {0, 1000}, "of k-means, at most");
  v("seed", c.seed, {0, INT64_MAX}, "of k-means");
}

}  // namespace sgs
