// Vector quantisation of a scene as in StreamingGS (DAC 2025): four codebooks, and for each
// Gaussian an entry of each.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

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
// (rotation_codebook.h), all in canonical form (vq_points.h). Opacities below 1/255, which no
// view can show, become 0, others at least 1. Deterministic by seed whatever the number of threads.
QuantisedCloud quantise(const ActivatedCloud& cloud, const std::vector<float>& weights,
                        const std::vector<float>& pixel_sizes, const VqConfig& config,
                        const VqProgress& progress = {});

// Finds for each Gaussian the entries that suit it best, of codebooks that are there: indices and
// opacities of `quantised` anew, by the distances that quantise() goes by; codebooks stay but for
// entries that no Gaussian is nearest to: each of these is put on the Gaussian whose error, times
// its weight, is the largest that is left (but for rotations, whose entries few are idle of).
// weights, pixel_sizes: as there. The same result whatever the number of threads.
void assign_entries(const ActivatedCloud& cloud, const std::vector<float>& weights,
                    const std::vector<float>& pixel_sizes, QuantisedCloud& quantised);

}  // namespace sgs
