// Paper order as sequences of splats: voxel after voxel as each group visits them, sorted by depth
// within a visit and not across visits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/render/paper_renderer.h"
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

// The voxels that paper order visits in each of several views, found once. They follow from the
// centres of the Gaussians alone, which a tuning that asks step after step leaves where they are.
class VisitPlan {
 public:
  // grid: must outlive the plan. most_bytes: host memory for visits that are kept; views that come
  // when it is full are followed anew each time. Keeping never changes a result.
  VisitPlan(const VoxelGrid& grid, const PaperOrderConfig& order, std::size_t most_bytes)
      : grid_(grid), order_(order), most_bytes_(most_bytes) {}

  // The sequences of view number `at` in paper order. cloud: in the grid's storage order, its
  // centres those of the grid. The candidates of a voxel are its slots, which lie together: they
  // take no list of their own.
  GroupSequences sequences(std::size_t at, const View<float>& view, const ActivatedCloud& cloud);

  const PaperOrderConfig& order() const { return order_; }
  std::size_t kept_bytes() const { return kept_bytes_; }

 private:
  using GroupVoxels = std::vector<std::vector<std::uint32_t>>;
  std::shared_ptr<const GroupVoxels> visits(std::size_t at, const View<float>& view);

  const VoxelGrid& grid_;
  const PaperOrderConfig order_;
  const std::size_t most_bytes_;
  std::size_t kept_bytes_ = 0;
  std::vector<std::shared_ptr<const GroupVoxels>> kept_;  // [view]
};

}  // namespace sgs
