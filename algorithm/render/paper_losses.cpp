// Projection of every voxel's Gaussians and their groups.
#include "algorithm/render/paper_losses.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "algorithm/render/blend_pass.h"
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

// The blend pass, group by group, over those splats that the group streamed.

namespace {

// [slot] its voxel.
std::vector<std::uint32_t> voxels_of(const VoxelGrid& grid, std::size_t slots) {
  std::vector<std::uint32_t> voxel_of(slots);
  for (std::uint32_t voxel = 0; voxel < grid.voxels.size(); ++voxel) {
    const VoxelRecord& record = grid.voxels[voxel];
    std::fill_n(voxel_of.begin() + record.first, record.count, voxel);
  }
  return voxel_of;
}

}  // namespace

Image render_visited_in_order(const View<float>& view, const ActivatedCloud& cloud,
                              const VoxelGrid& grid, const PixelSize& group,
                              const std::vector<std::vector<std::uint32_t>>& group_voxels,
                              const glm::vec3& background) {
  const std::vector<std::uint32_t> voxel_of = voxels_of(grid, cloud.size());
  std::vector<std::vector<std::uint32_t>> visited = group_voxels;
  for (std::vector<std::uint32_t>& voxels : visited) std::sort(voxels.begin(), voxels.end());
  const int columns = (view.width + group.width - 1) / group.width;
  const auto blend_visited = [&](GroupState& state, const Splat& splat) {
    const PixelRect& pixels = state.pixels();
    const auto at =
        static_cast<std::size_t>(pixels.y0 / group.height * columns + pixels.x0 / group.width);
    if (std::binary_search(visited[at].begin(), visited[at].end(), voxel_of[splat.index])) {
      state.blend(splat);
    }
  };
  RenderResult result(view.width, view.height);
  for (const GroupState& state : blend_scene(view, cloud, blend_visited, group)) {
    state.store(background, result);
  }
  return std::move(result.image);
}

}  // namespace sgs
