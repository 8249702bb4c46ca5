// What paper order loses: splats that touch a pixel group although no ray of the group crosses the
// voxel of their centre.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

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

}  // namespace sgs
