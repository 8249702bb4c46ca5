// How near a scene comes to photographs.
#pragma once

#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"

namespace sgs {

struct Nearness {
  double psnr_db, ssim;
};

// Of each photograph, before `background`, in the reference order. What the scene shows is rounded
// to 8 bits neither here nor in PSNR.
std::vector<Nearness> nearness(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background);

// Means over all of them, PSNR in dB.
Nearness mean_nearness(const std::vector<Nearness>& each);

}  // namespace sgs
