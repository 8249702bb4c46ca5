// The quality of a scene's pictures beside photographs.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"

namespace sgs {

struct Quality {
  double psnr_db, ssim;
};

// Is shown what the scene looks like from where photograph `at` was taken.
using PictureSeen = std::function<void(std::size_t at, const Image& picture)>;

// Of each photograph, before `background`, in the reference order. What the scene shows is rounded
// to 8 bits neither here nor in PSNR.
std::vector<Quality> qualities(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background, const PictureSeen& seen = {});

// Means over all of them, PSNR in dB.
Quality mean_quality(const std::vector<Quality>& each);

}  // namespace sgs
