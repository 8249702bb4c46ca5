// How far a Gaussian is visible along each of the world's axes, and a code of 4 B for it that is
// rounded up, never down. With k = sqrt(2 ln(255 opacity)), beyond which alpha is below 1/255, and
// Sigma the covariance, the half-extent along axis a is k sqrt(Sigma_aa).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/splat/gaussian.h"

namespace sgs {

struct VisibleExtents {
  glm::vec3 extent{0.0F};  // half-extents, world units
  float scale_max = 0;     // the largest scale
};

// Rounded up in float.
VisibleExtents visible_extents(const Gaussian<float>& g);

// Levels are powers of 2^(1/16), so that decoding adds whole numbers and looks up a fraction out of
// 16. The scale takes every other level, from 2^-8 to 2^23.75 world units; a smaller one is stored
// as 2^-8, and beyond, which gaussian_cloud.h does not allow, the last code stands for infinity.
// It is there for the condition of splats hundreds of pixels wide, where small ones do not matter.
// The extents, which decide what is fetched, are counted down from the level that no opacity
// exceeds.
struct ExtentCode {
  std::uint8_t scale = 0;
  std::uint8_t below[3] = {255, 255, 255};
};
static_assert(sizeof(ExtentCode) == 4);

// The smallest code that decodes to no less, in the scale and along each axis (while that is within
// k of the scale, as it is for a rotation).
ExtentCode encode_extents(const VisibleExtents& extents);
VisibleExtents decode_extents(const ExtentCode& code);
// A level of the scale and of each axis.
constexpr std::uint32_t kExtentLookUps = 4;

}  // namespace sgs
