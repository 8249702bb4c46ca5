// Training as Markov chain Monte Carlo (Kheradmand et al. 2024, "3D Gaussian splatting as Markov
// chain Monte Carlo"): relocation and noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/adam.h"

namespace sgs {

// Relocation: Gaussians that are not needed go where others are at work. The picture hardly
// changes, and the number of Gaussians is what one says it is.

// Opacity and scales of each of `count` Gaussians that stand in one's place and look like it
// together, equation 9 of the source:
//   o' = 1 - (1 - o)^(1 / n),
//   s' = s o / sum_{i=1..n} sum_{k<i} C(i - 1, k) (-1)^k o'^(k + 1) / sqrt(k + 1).
struct Division {
  double opacity;
  double scale_factor;  // s' / s
};
// opacity: in (0, 1); count: at least 1, taken as 51 where it is more.
Division divided(double opacity, int count);

constexpr double kDeadOpacity = 0.005;

// Both happen at one step. The Gaussians that are divided are drawn from the seed, in proportion to
// opacity. Moments of those that are moved or divided begin anew.

// Each Gaussian of at most kDeadOpacity takes a share of one above it. Returns how many: none where
// none is above.
std::size_t relocate_dead(GaussianCloud& cloud, Adam& adam, std::uint64_t seed, std::uint64_t step);

// `count` more, at the end of the cloud, each a share of one that is there. None where all are
// dead.
void add_shares(std::size_t count, GaussianCloud& cloud, Adam& adam, std::uint64_t seed,
                std::uint64_t step);

// Noise: random steps let Gaussians that are hardly there find where they are of use, mean +=
// factor sigmoid(100 (0.005 - opacity)) Sigma xi, xi normal of the seed, the step and the Gaussian.
// factor: 1/world units. activated: activate(cloud). Gaussians of an opacity above 0.25 would move
// by less than 2^-30 of that and stay. Returns those that were moved, ascending.
std::vector<std::uint32_t> add_position_noise(GaussianCloud& cloud, const ActivatedCloud& activated,
                                              double factor, std::uint64_t seed,
                                              std::uint64_t step);

}  // namespace sgs
