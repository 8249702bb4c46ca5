// Which splats are blended into which pixels of a frame, and in which order: all that a picture and
// its derivatives need to know of an order of rendering. Made once a step, drawn, and
// differentiated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// In place of a position in GroupSequences::splats: of a Gaussian that has none.
constexpr std::uint32_t kNoSplat = 0xffffffff;

struct GroupSequences {
  int width = 0, height = 0;           // px, of the frame
  std::vector<Splat> splats;           // each Gaussian that may be seen, once
  std::vector<PixelRect> groups;       // they cover the frame; corners on multiples of 4
  std::vector<std::size_t> first;      // [groups + 1] where each group's sequence begins
  std::vector<std::uint32_t> entries;  // positions in splats, in the order of blending

  // The splat of an entry. Those of the next entries are fetched ahead: a group's splats lie all
  // over the frame's, and without it half of the time is waiting.
  const Splat& splat_of(std::size_t entry) const {
    constexpr std::size_t kAhead = 8;
    const Splat& ahead = splats[entries[std::min(entry + kAhead, entries.size() - 1)]];
    __builtin_prefetch(&ahead);
    __builtin_prefetch(&ahead.footprint);
    return splats[entries[entry]];
  }
};

// The reference renderer's: front to back, equal depths by index. 60 B a splat and 4 B for each
// group of 32 x 32 px that it falls on, which nothing bounds.
GroupSequences reference_sequences(const View<float>& view, const ActivatedCloud& cloud);

// The picture: that of the order's renderer, bit for bit, whatever the number of threads.
RenderResult draw(const GroupSequences& sequences, const glm::vec3& background = glm::vec3(0.0F),
                  BlendPrecision precision = BlendPrecision::kSingle);

// Paper order as sequences of splats: voxel after voxel as each group visits them, sorted by depth
// within a visit and not across visits.

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
