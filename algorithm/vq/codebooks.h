// Vector quantisation of a scene: four codebooks, and for each Gaussian an entry of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algorithm/splat/gaussian.h"

namespace sgs {

enum class Codebook : std::uint8_t { kScale, kRotation, kDc, kSh };
constexpr std::size_t kCodebookCount = 4;
constexpr std::array<const char*, kCodebookCount> kCodebookNames = {"scale", "rotation", "dc",
                                                                    "sh"};

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

struct VqConfig {
  std::uint32_t scale_entries = 4096;  // most entries of each codebook
  std::uint32_t rotation_entries = 4096;
  std::uint32_t dc_entries = 4096;
  std::uint32_t sh_entries = 512;
  std::uint32_t iterations = 20;  // of k-means, at most
  std::uint64_t seed = 1;

  std::uint32_t entries(Codebook codebook) const {
    const std::uint32_t all[kCodebookCount] = {scale_entries, rotation_entries, dc_entries,
                                               sh_entries};
    return all[static_cast<std::size_t>(codebook)];
  }
};

struct QuantisedCloud {
  // [K, words] of each codebook; empty: the scene has none. No more entries than distinct values.
  std::array<std::vector<float>, kCodebookCount> codebooks;
  std::array<std::vector<std::uint32_t>, kCodebookCount> indices;  // [N]
  std::vector<std::uint8_t> opacities;                             // [N] in units of 1/255
};

// Told after each iteration: codebook, iteration, weighted mean squared error.
using VqProgress = std::function<void(Codebook, std::uint32_t, double)>;

// weights: [N], not negative; pixel_sizes: [N] world units of a pixel at each Gaussian, 0 where not
// known (image_weights.h has both). Scales are compared as logarithms relative to the largest,
// which the first half stores exactly; rotations by what a wrong one does to the picture
// (rotation_codebook.h), all in canonical form (canonical_shape.h). Opacities below 1/255, which no
// view can show, become 0, others at least 1. Deterministic by seed whatever the number of threads.
QuantisedCloud quantise(const ActivatedCloud& cloud, const std::vector<float>& weights,
                        const std::vector<float>& pixel_sizes, const VqConfig& config,
                        const VqProgress& progress = {});

}  // namespace sgs
