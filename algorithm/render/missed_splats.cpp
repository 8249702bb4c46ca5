// Projection of every voxel's Gaussians and their groups.
#include "algorithm/render/missed_splats.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

MissedSplats::MissedSplats(const View<float>& view, const ActivatedCloud& cloud,
                           const VoxelGrid& grid, const PixelSize& group_size)
    : voxel_count_(grid.voxels.size()) {
  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, group_size);
  const int columns = (view.width + group_size.width - 1) / group_size.width;
  using Lists = std::vector<std::vector<std::uint32_t>>;
  tbb::enumerable_thread_specific<Lists> local([&] { return Lists(groups.size()); });
  const int across = group_size.width / kSubtilePx, down = group_size.height / kSubtilePx;

  const auto note_voxel = [&](std::uint32_t voxel, Lists& lists) {
    const VoxelRecord& record = grid.voxels[voxel];
    for (std::uint32_t slot = record.first; slot < record.first + record.count; ++slot) {
      Splat splat;
      if (!make_geometry(view, cloud.gaussians[slot], splat)) continue;
      const SubtileRect& f = splat.footprint;
      for (int y = f.y0 / down; y <= (f.y1 - 1) / down; ++y) {
        for (int x = f.x0 / across; x <= (f.x1 - 1) / across; ++x) {
          const auto group = static_cast<std::size_t>(y * columns + x);
          if (reaches_group(splat, groups[group])) lists[group].push_back(voxel);
        }
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(voxel_count_)),
                    [&](const auto& range) {
                      Lists& lists = local.local();
                      for (std::uint32_t v = range.begin(); v != range.end(); ++v) {
                        note_voxel(v, lists);
                      }
                    });
  touching_.resize(groups.size());
  for (const Lists& lists : local) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      touching_[g].insert(touching_[g].end(), lists[g].begin(), lists[g].end());
    }
  }
}

std::uint64_t MissedSplats::count(std::size_t group,
                                  const std::vector<std::uint32_t>& visited_voxels) const {
  std::vector<char> visited(voxel_count_, 0);
  for (const std::uint32_t voxel : visited_voxels) visited[voxel] = 1;
  const auto& touching = touching_[group];
  return static_cast<std::uint64_t>(std::count_if(touching.begin(), touching.end(),
                                                  [&](std::uint32_t v) { return !visited[v]; }));
}

}  // namespace sgs
