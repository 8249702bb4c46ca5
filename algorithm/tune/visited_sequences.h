// Paper order as sequences of splats: voxel after voxel as each group visits them, sorted by depth
// within a visit and not across visits.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/tune/group_sequences.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The sequences of render_paper_order(). grid: of this cloud, which is in storage order.
// group_voxels: as in StreamingResult; they follow from the centres alone, so that whoever leaves
// those where they are has them made once for each view. group, visit_gaussians: as in
// PaperOrderConfig.
GroupSequences visited_sequences(const View<float>& view, const ActivatedCloud& cloud,
                                 const VoxelGrid& grid,
                                 const std::vector<std::vector<std::uint32_t>>& group_voxels,
                                 const PixelSize& group, std::uint32_t visit_gaussians = 0);

}  // namespace sgs
