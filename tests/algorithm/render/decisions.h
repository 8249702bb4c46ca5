// Where float decides otherwise than double: tile rectangles and depth order of a whole frame,
// each difference held against the rounding that float can make there.
#pragma once

#include <cstddef>
#include <string>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

struct Decisions {
  std::size_t in_front = 0;        // Gaussians in front of the near plane, in double
  std::size_t near_plane = 0;      // in front in one arithmetic only
  std::size_t rect_differs = 0;    // tile rectangle differs
  std::size_t rect_uncertain = 0;  // rounding could have changed the rectangle
  std::size_t order_differs = 0;   // follows in float a splat that is farther in double
  std::size_t unexplained = 0;     // differences, of value or decision, that rounding cannot make
  double worst_share = 0;          // largest |float - double| over its bound, of x, y and depth
  std::string first_unexplained;   // for the message
};

// Projects the cloud in float as the renderers do, in double as the oracle does, and with tracked
// errors; compares centre, depth, rectangle and order of every Gaussian.
Decisions compare_decisions(const Camera& camera, const GaussianCloud& cloud);

}  // namespace sgs::test
