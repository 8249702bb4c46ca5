// The blend pass, group by group, over those splats that the group streamed.
#include "algorithm/render/visited_in_order.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "algorithm/render/blend_pass.h"

namespace sgs {
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
  RenderResult result;
  result.image = Image(view.width, view.height);
  result.transmittance.resize(result.image.pixels.size());
  result.contributors.resize(result.image.pixels.size());
  for (const GroupState& state : blend_scene(view, cloud, blend_visited, group)) {
    state.store(background, result);
  }
  return std::move(result.image);
}

}  // namespace sgs
