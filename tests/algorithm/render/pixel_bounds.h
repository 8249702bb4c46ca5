// Every pixel of the reference renderer and of the double-precision oracle within the rounding that
// float can make of its formula.
#pragma once

#include <cstddef>
#include <string>

#include "algorithm/render/render_result.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

struct PixelBounds {
  std::size_t pixels = 0;
  std::size_t narrow = 0;   // of these, within 1/512 of the largest colour that a splat has
  std::size_t outside = 0;  // pixels of either that no rounding explains
  std::string first_outside;
};

// Blends the frame once more with intervals: each operation of sections 2 and 3 carries a bound on
// what float makes of it (tracked.h), and where a decision (alpha against 1/255, power against 0,
// transmittance against 1e-4) lies within rounding both ways are followed and their hull is kept.
// Order and tile rectangles are those of float; compare_decisions (decisions.h) is what judges
// them. Both pictures must lie in the interval, so that their difference is at most its width.
// in_float: what the reference renderer makes of it.
PixelBounds bound_pixels(const Camera& camera, const GaussianCloud& cloud,
                         const RenderResult& in_float);

}  // namespace sgs::test
