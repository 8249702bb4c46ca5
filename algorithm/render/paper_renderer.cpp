// Paper order, one task a group.
#include "algorithm/render/paper_renderer.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "algorithm/render/blend_watch.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/missed_splats.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {
namespace {

struct GridTable {
  const VoxelGrid& grid;
  const VoxelNode& node(std::uint32_t index) const { return grid.nodes[index]; }
};

// Splats of one visit, front to back, equal depths by slot.
void filter_and_sort(const View<float>& view, const ActivatedCloud& cloud, const VoxelGrid& grid,
                     const VoxelRecord& voxel, const PixelRect& pixels, bool coarse_filter,
                     std::vector<Splat>& run, StreamingStats& stats) {
  run.clear();
  for (std::uint32_t slot = voxel.first; slot < voxel.first + voxel.count; ++slot) {
    const Gaussian<float>& g = cloud.gaussians[slot];
    if (coarse_filter) {
      const float scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
      const CoarseBound bound = coarse_bound(view, g.mean, scale_max);
      if (!bound.in_front || !touches(bound, pixels)) continue;
    }
    ++stats.coarse_passed;
    ++stats.second_halves;
    Splat splat;
    if (!make_geometry(view, g, splat) || !reaches_group(splat, pixels)) continue;
    add_colour(view, cloud.sh_degree, g.mean, cloud.sh(slot), splat);
    splat.index = slot;
    run.push_back(splat);
  }
  std::sort(run.begin(), run.end(), in_front);
  stats.first_halves += voxel.count;
  stats.splats += run.size();
  stats.visit_splats_max = std::max<std::uint64_t>(stats.visit_splats_max, run.size());
}

}  // namespace

GroupVisits paper_visits(const View<float>& view, const PixelRect& group, const VoxelGrid& grid,
                         float sample_step_voxels, OrderingTable& table) {
  const auto nothing = [](std::uint32_t, std::size_t) {};
  if (grid.nodes.empty()) return {};
  const GridTable nodes{grid};
  if (sample_step_voxels > 0) {
    RaySampling sampling(grid.frame, nodes, sample_step_voxels);
    return group_visits(view, group, sampling, table, nothing);
  }
  RayWalk walk(grid.frame, nodes);
  return group_visits(view, group, walk, table, nothing);
}

StreamingResult render_paper_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const VoxelGrid& grid, const PaperOrderConfig& config) {
  StreamingResult out;
  const auto pixels = static_cast<std::size_t>(view.width) * view.height;
  out.frame.image = Image(view.width, view.height);
  out.frame.transmittance.resize(pixels);
  out.frame.contributors.resize(pixels);

  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, config.group_px);
  const MissedSplats missed(view, cloud, grid, config.group_px);
  std::vector<StreamingStats> stats(groups.size());
  out.group_voxels.resize(groups.size());
  Flags contributing(cloud.size()), visited(grid.voxels.size());
  tbb::enumerable_thread_specific<OrderingTable> tables(grid.voxels.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t index) {
    const PixelRect& group = groups[index];
    StreamingStats& s = stats[index];
    GroupVisits visits = paper_visits(view, group, grid, config.sample_step_voxels, tables.local());
    s.groups = 1;
    s.ray_steps = visits.steps;
    s.edges_offered = visits.edges_offered;
    s.table_bytes_max = visits.table_bytes;
    s.missed = missed.count(index, visits.voxels);

    GroupState state(group, view.width, view.height, config.precision);
    BlendWatch watch(state.subtile_count());
    std::vector<Splat> run;
    for (const std::uint32_t voxel : visits.voxels) {
      if (state.saturated()) {
        ++s.visits_saturated;
        continue;
      }
      ++s.visits;
      visited.set(voxel);
      filter_and_sort(view, cloud, grid, grid.voxels[voxel], group, config.coarse_filter, run, s);
      for (const Splat& splat : run) {
        if (state.saturated()) break;
        const auto observe = [&](const SubtileBlend& blend) {
          if (watch.see(blend, splat.depth)) contributing.set(splat.index);
        };
        s.subtile_blends += state.blend(splat, observe).blended;
      }
    }
    s.misordered = watch.misordered();
    s.contributors = state.contributors();
    state.store(config.background, out.frame);
    out.group_voxels[index] = std::move(visits.voxels);
  });
  for (const StreamingStats& s : stats) out.stats += s;
  out.stats.contributing = contributing.count();
  out.stats.blocks_visited = visited.count();
  return out;
}

}  // namespace sgs
