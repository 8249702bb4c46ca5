// Blending of one group of pixels, done once more and differentiated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/tune/scene_gradient.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// What a group's pixels say of the splats that were blended into them, in the order of blending.
struct GroupPartials {
  std::vector<std::uint32_t> splats;  // positions in the sequences' splats
  std::vector<SplatGradient<float>> gradients;
};

GroupPartials group_gradient(const DrawnScene& scene, std::size_t group,
                             const PixelGradient& by_pixel, GradientRule rule);

}  // namespace sgs
