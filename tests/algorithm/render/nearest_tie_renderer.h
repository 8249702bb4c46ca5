// Paper order with another rule for ties: among voxels that no ray puts in order, the one whose
// middle is nearest to the camera goes first. Any such rule is a valid paper order; this one shows
// how much of a picture's loss is the rule's.
#pragma once

#include "algorithm/image/image.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs::test {

Image render_with_nearest_ties(const View<float>& view, const ActivatedCloud& cloud,
                               const VoxelGrid& grid, const PixelSize& group);

}  // namespace sgs::test
