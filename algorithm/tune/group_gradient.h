// Blending of one group of pixels, done once more and differentiated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/blend.h"
#include "algorithm/tune/scene_gradient.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// What a group's pixels say of the splats that were blended into them, back to front.
struct GroupPartials {
  std::vector<std::uint32_t> splats;  // positions in the sequences' splats
  std::vector<SplatGradient<float>> gradients;
};

// Keeps its memory from group to group.
class GroupGradient {
 public:
  GroupPartials differentiate(const DrawnScene& scene, std::size_t group,
                              const PixelGradient& by_pixel, GradientRule rule);

 private:
  // One splat in one sub-tile.
  struct Blend {
    std::uint32_t entry;  // of the sequences
    std::uint32_t at;     // the sub-tile's place in the group
    std::uint16_t x, y;   // the sub-tile, in the whole frame
  };

  void blend(const DrawnScene& scene, std::size_t group);

  std::vector<Blend> blends_;  // in the order of blending
  std::vector<LaneShares> shares_;
};

}  // namespace sgs
