// Check of the reference renderer against pictures made elsewhere.
#pragma once

#include <string>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"

namespace sgs::test {

// Renders `camera` and compares with its lines in the CSV file at `path` (view,x,y,r,g,b,t,n;
// x = y = -1: means of the whole view and its total of contributors): >= 99.7 % of pixels within
// 1e-4, PSNR >= 65 dB, contributors within 0.1 %. Prints a line.
void check_against_golden(const std::string& path, const Camera& camera,
                          const ActivatedCloud& cloud);

}  // namespace sgs::test
