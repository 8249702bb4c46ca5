// A graph of its own for each group, and the plain way from a voxel to its splats.
#include "tests/algorithm/render/nearest_tie_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/voxel/ray_path.h"
#include "tests/algorithm/voxel/ray_walk.h"

namespace sgs::test {
namespace {

struct GridTable {
  const VoxelGrid& grid;
  VoxelNode node(std::uint32_t index) const { return grid.nodes[index]; }
};

// Squared distance of each voxel's middle from the camera.
std::vector<double> distances(const View<float>& view, const ActivatedCloud& cloud,
                              const VoxelGrid& grid) {
  std::vector<double> out;
  const float size = grid.frame.voxel_size;
  for (const VoxelRecord& record : grid.voxels) {
    const glm::vec3& mean = cloud.gaussians[record.first].mean;
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = (cell_of(mean[axis], size) + 0.5) * size - view.position[axis];
      squared += d * d;
    }
    out.push_back(squared);
  }
  return out;
}

std::vector<std::uint32_t> order(const View<float>& view, const PixelRect& group,
                                 const VoxelGrid& grid, const std::vector<double>& distance) {
  std::map<std::uint32_t, std::set<std::uint32_t>> successors;
  std::map<std::uint32_t, std::uint32_t> in_degree;
  const GridTable table{grid};
  RayWalk walk(RayPath<>(grid.frame), table);
  std::vector<std::uint32_t> chain, chain_before;
  for (int y = group.y0; y < group.y1; ++y) {
    for (int x = group.x0; x < group.x1; ++x) {
      chain.clear();
      walk.walk(pixel_ray(view, x, y), [&](std::uint32_t voxel, std::uint32_t) {
        chain.push_back(voxel);
        return true;
      });
      if (chain == chain_before) continue;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        in_degree.emplace(chain[i], 0);
        if (i > 0 && successors[chain[i - 1]].insert(chain[i]).second) ++in_degree[chain[i]];
      }
      chain_before = chain;
    }
  }
  std::set<std::pair<double, std::uint32_t>> ready;
  for (const auto& [voxel, degree] : in_degree) {
    if (degree == 0) ready.emplace(distance[voxel], voxel);
  }
  std::vector<std::uint32_t> out;
  while (!ready.empty()) {
    const std::uint32_t voxel = ready.begin()->second;
    ready.erase(ready.begin());
    out.push_back(voxel);
    for (const std::uint32_t next : successors[voxel]) {
      if (--in_degree[next] == 0) ready.emplace(distance[next], next);
    }
  }
  return out;
}

}  // namespace

Image render_with_nearest_ties(const View<float>& view, const ActivatedCloud& cloud,
                               const VoxelGrid& grid, const PixelSize& group) {
  RenderResult frame(view.width, view.height);
  const std::vector<double> distance = distances(view, cloud, grid);
  const auto groups = pixel_groups(view.width, view.height, group);
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    GroupState state(groups[g], view.width, view.height);
    std::vector<Splat> run;
    for (const std::uint32_t voxel : order(view, groups[g], grid, distance)) {
      if (state.saturated()) break;
      run.clear();
      const VoxelRecord& record = grid.voxels[voxel];
      for (std::uint32_t slot = record.first; slot < record.first + record.count; ++slot) {
        const Gaussian<float>& gaussian = cloud.gaussians[slot];
        Splat splat{};
        if (!make_geometry(view, gaussian, splat) || !reaches_group(splat, groups[g])) continue;
        add_colour(view, cloud.sh_degree, gaussian.mean, cloud.sh(slot), splat);
        splat.index = slot;
        run.push_back(splat);
      }
      std::sort(run.begin(), run.end(), in_front);
      for (const Splat& splat : run) state.blend(splat);
    }
    state.store(glm::vec3(0.0F), frame);
  });
  return frame.image;
}

}  // namespace sgs::test
