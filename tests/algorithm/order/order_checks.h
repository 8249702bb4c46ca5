// Orders of whole scenes: every ray's chain is respected, no group is cyclic, and no visit
// contradicts the Manhattan distance from the camera's cell.
#pragma once

#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs::test {

// One view in groups of group_size. cloud: in storage order.
void check_order(const ActivatedCloud& cloud, const VoxelGrid& grid, const Camera& camera,
                 const PixelSize& group_size);

// Every view of a scene in groups of 16 and of 64 px. cameras: empty for the scene's own.
// voxel_size: 0 for the paper's.
void check_order(const std::string& spec, const std::vector<Camera>& cameras, float voxel_size);

// A scene of ../shared with its cameras.
void check_order_of_shared(const std::string& name);

}  // namespace sgs::test
