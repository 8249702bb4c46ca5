// The two losses of paper order (StreamingGS, DAC 2025): missed splats, and the picture that has no
// other loss.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The splats that paper order misses: they touch a pixel group although no ray of the group crosses
// the voxel of their centre.
class MissedSplats {
 public:
  // Projects the whole cloud and notes for each group the voxels of the splats that touch it.
  MissedSplats(const View<float>& view, const ActivatedCloud& cloud, const VoxelGrid& grid,
               const PixelSize& group);

  // Splats touching the group (index in pixel_groups order) whose voxel is not among those visited.
  std::uint64_t count(std::size_t group, const std::vector<std::uint32_t>& visited_voxels) const;

 private:
  std::size_t voxel_count_;
  std::vector<std::vector<std::uint32_t>> touching_;  // [group] voxel of each splat that touches it
};

// Paper order without its misordering, which tells its two losses apart: the reference image less
// the splats that paper order misses: each pixel blends, by (depth, slot), all splats of the voxels
// that its group's rays cross. Against the reference only missed splats are wrong; a paper-order
// frame differs from it only by the order, which includes what that frame left out because a pixel
// was finished too early. Where no splat is missed it is the reference image, bit for bit.
// Misordering without missing has no picture: a missed splat has no place in the paper's order.
// grid: of this cloud, which is in storage order. group_voxels: as in StreamingResult. The same
// bits whatever the number of threads.
Image render_visited_in_order(const View<float>& view, const ActivatedCloud& cloud,
                              const VoxelGrid& grid, const PixelSize& group,
                              const std::vector<std::vector<std::uint32_t>>& group_voxels,
                              const glm::vec3& background);

}  // namespace sgs
