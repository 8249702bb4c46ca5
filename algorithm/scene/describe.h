// The summary of a scene in numbers: counts, extents, sizes.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// Axis-aligned box in the world frame.
struct Extent {
  glm::vec3 min{0.0f}, max{0.0f};
};

struct SceneSummary {
  std::uint64_t count = 0;              // Gaussians
  int sh_degree = 0;                    // 0 to 3
  Extent extent;                        // box of all centres
  Extent inner_extent;                  // box between the 0.1 % and 99.9 % quantiles of each axis
  std::uint64_t invisible_count = 0;    // opacity < 1/255: no view can show them
  double median_opacity = 0;            // 0 to 1
  double median_scale = 0;              // largest scale of each Gaussian, world units
  double max_scale = 0;                 // world units
  double max_scale_ratio = 0;           // largest over smallest scale of one Gaussian
  std::uint64_t first_half_bytes = 0;   // x, y, z, largest scale: 16 B each
  std::uint64_t second_half_bytes = 0;  // everything else in float: 40 to 220 B each by degree
};

// Quantiles are taken by nearest rank. An empty cloud gives zeros.
SceneSummary summarise(const GaussianCloud& cloud);

}  // namespace sgs
