// Checks of the reference renderer against the double-precision oracle.
#pragma once

#include <string>

#include "algorithm/image/image.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "testbench/oracle/double_oracle.h"

namespace sgs::test {

Image as_image(const OracleImage& oracle);

// Step 1: float blending with the oracle's splats, rectangles and order against double blending:
// PSNR >= 95 dB, >= 99.97 % of pixels within 1e-4.
// Step 2: the float projection's own rectangles and order: every difference is one that rounding
// can make. Prints a line for each.
void check_against_double(const std::string& name, const Camera& camera,
                          const GaussianCloud& cloud);

}  // namespace sgs::test
