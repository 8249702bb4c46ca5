// The quality of a scene's pictures beside photographs.
#pragma once

#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"

namespace sgs {

struct Quality {
  double psnr_db, ssim;
};

// Of each photograph, before `background`, in the reference order. What the scene shows is rounded
// to 8 bits neither here nor in PSNR.
std::vector<Quality> qualities(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background);

// Means over all of them, PSNR in dB.
Quality mean_quality(const std::vector<Quality>& each);

}  // namespace sgs
