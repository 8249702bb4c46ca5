// How far two pictures are apart: PSNR, SSIM, largest error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numeric>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// Throws InputError unless both pictures have the same width and height and at least one pixel.
void check_same_size(const Image& a, const Image& b);

// Value limited to [0, 1]; NaN stays NaN.
inline float clamp_to_unit(float value) { return std::clamp(value, 0.0f, 1.0f); }
inline glm::vec3 clamp_to_unit(const glm::vec3& pixel) {
  return {clamp_to_unit(pixel.x), clamp_to_unit(pixel.y), clamp_to_unit(pixel.z)};
}

// Largest |a - b| of a channel. Equal infinities and two NaN agree; a NaN on one side only is an
// infinite error, so that it cannot hide.
double pixel_error(const glm::vec3& a, const glm::vec3& b);

// All measures throw InputError when the pictures differ in size or have no pixels.

// Peak signal-to-noise ratio in dB over all pixels and channels, both pictures clamped to [0, 1]:
// -10 log10(MSE). Infinity for equal pictures, NaN where a picture holds NaN.
double psnr_db(const Image& a, const Image& b);

// Structural similarity (Wang et al. 2004), mean over pixels and channels, both pictures clamped to
// [0, 1]: 11x11 Gaussian window of sigma 1.5 px, zero padding, C1 = 0.01^2, C2 = 0.03^2, as in the
// loss of Kerbl et al. 2023. 1 for equal pictures, NaN (without a sign) where a picture holds NaN.
// The result does not depend on the number of threads.
double ssim(const Image& a, const Image& b);

// Largest |a - b| over pixels and channels, not clamped. A NaN on one side only counts as infinity.
double max_abs_error(const Image& a, const Image& b);

// Pixels of which a channel differs.
std::uint64_t differing_pixels(const Image& a, const Image& b);

// Share of the pixels, 0 to 1, whose three channels all differ by at most `tolerance`.
double fraction_within(const Image& a, const Image& b, double tolerance);

// The window and the constants of SSIM (Wang et al. 2004), as in the loss of Kerbl et al. 2023.
constexpr int kSsimRadiusPx = 5;  // 11x11 window
constexpr int kSsimTaps = 2 * kSsimRadiusPx + 1;
constexpr double kSsimSigmaPx = 1.5;
constexpr double kSsimC1 = 0.01 * 0.01;  // (0.01 L)^2 with L = 1, the range of the values
constexpr double kSsimC2 = 0.03 * 0.03;

// One side of the separable window; its sum is 1.
inline std::array<double, kSsimTaps> ssim_window() {
  std::array<double, kSsimTaps> window{};
  for (int i = 0; i < kSsimTaps; ++i) {
    const double offset = i - kSsimRadiusPx;
    window[i] = std::exp(-offset * offset / (2.0 * kSsimSigmaPx * kSsimSigmaPx));
  }
  const double sum = std::accumulate(window.begin(), window.end(), 0.0);
  for (double& weight : window) weight /= sum;
  return window;
}

// The part of one step in the error of all.
struct ErrorPart {
  double share = 0;  // in the squared error; below 0 where the step takes back what others add
  double alone = 0;  // its own square over the squared error; never below 0
};

// chain: at least two pictures; each is the one before it and one more step of loss. Returns a part
// for each step. Pictures are clamped to [0, 1] first, as for PSNR. With d_i the difference that
// step i makes, e their sum (last picture minus first) and <,> the sum over pixels and channels:
//
//   <e, e> = sum_i <d_i, d_i> + sum_{i<j} 2 <d_i, d_j>
//   share_i = <d_i, e> / <e, e>      alone_i = <d_i, d_i> / <e, e>
//
// A share is the step's own square and one half of each cross term that it has a part in, so shares
// add up to 1. The squares alone do not: 1 - sum_i alone_i is what all cross terms come to. NaN
// where the ends of the chain are equal or a picture holds NaN. Throws InputError when the pictures
// differ in size or have no pixels.
std::vector<ErrorPart> error_parts(const std::vector<const Image*>& chain);

}  // namespace sgs
