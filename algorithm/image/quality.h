// How far two pictures are apart: PSNR, SSIM, largest error.
#pragma once

#include <cstdint>

#include "algorithm/image/image.h"

namespace sgs {

// All of these throw InputError when the pictures differ in size or have no pixels.

// Peak signal-to-noise ratio in dB over all pixels and channels, both pictures clamped to [0, 1]:
// -10 log10(MSE). Infinity for equal pictures, NaN where a picture holds NaN.
double psnr_db(const Image& a, const Image& b);

// Structural similarity, mean over pixels and channels, both pictures clamped to [0, 1]: 11x11
// Gaussian window of sigma 1.5 px, zero padding, C1 = 0.01^2, C2 = 0.03^2, as in the loss of
// Kerbl et al. 2023. 1 for equal pictures, NaN (without a sign) where a picture holds NaN. The
// result does not depend on the number of threads.
double ssim(const Image& a, const Image& b);

// Largest |a - b| over pixels and channels, not clamped. A NaN on one side only counts as infinity.
double max_abs_error(const Image& a, const Image& b);

// Pixels of which a channel differs.
std::uint64_t differing_pixels(const Image& a, const Image& b);

// Share of the pixels, 0 to 1, whose three channels all differ by at most `tolerance`.
double fraction_within(const Image& a, const Image& b, double tolerance);

}  // namespace sgs
