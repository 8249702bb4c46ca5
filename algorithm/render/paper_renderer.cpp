// Paper order, one task a group.
#include "algorithm/render/paper_renderer.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "algorithm/memory/splat_record.h"
#include "algorithm/render/blend_watch.h"
#include "algorithm/render/group_shape.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_losses.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/voxel/cell_samples.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {
namespace {

struct GridTable {
  const VoxelGrid& grid;
  const VoxelNode& node(std::uint32_t index) const { return grid.nodes[index]; }
};

// A part of a group while it is being rendered.
struct Part {
  PixelRect pixels;
  GroupState state;
  BlendWatch watch;
  std::vector<Splat> run;  // splats of one visit

  Part(const PixelRect& at, const View<float>& view, const PaperOrderConfig& config)
      : pixels(at),
        state(at, view.width, view.height, config.precision, config.subtile_test),
        watch(state.subtile_count()) {}
};

bool all_saturated(const std::vector<Part>& parts) {
  return std::all_of(parts.begin(), parts.end(),
                     [](const Part& part) { return part.state.saturated(); });
}

// Splats of one visit into the parts that they reach, front to back, equal depths by slot.
void filter_and_sort(const View<float>& view, const ActivatedCloud& cloud, const VoxelRecord& voxel,
                     const PaperOrderConfig& config, std::vector<Part>& parts,
                     StreamingStats& stats) {
  for (Part& part : parts) part.run.clear();
  for (std::uint32_t slot = voxel.first; slot < voxel.first + voxel.count; ++slot) {
    const Gaussian<float>& g = cloud.gaussians[slot];
    const CoarseBound bound =
        coarse_bound(view, g.mean, std::max({g.scale.x, g.scale.y, g.scale.z}));
    const auto passes = [&](const Part& part) {
      if (part.pixels.empty()) return false;
      return !config.coarse_filter || (bound.in_front && touches(bound, part.pixels));
    };
    std::uint32_t tests = 0;
    Splat splat;
    bool on_screen = false, coloured = false;
    for (Part& part : parts) {
      if (!passes(part)) continue;
      if (tests++ == 0) on_screen = make_geometry(view, g, splat);
      if (!on_screen || !reaches_group(splat, part.pixels)) continue;
      if (!coloured) add_colour(view, cloud.sh_degree, g.mean, cloud.sh(slot), splat);
      coloured = true;
      splat.index = slot;
      part.run.push_back(rounded_splat(config.splats, splat));
    }
    stats.coarse_passed += tests > 0 ? 1 : 0;
    stats.second_halves += tests > 0 ? 1 : 0;
    stats.fine_tests += tests;
  }
  stats.first_halves += voxel.count;
  for (Part& part : parts) {
    std::sort(part.run.begin(), part.run.end(), in_front);
    stats.splats += part.run.size();
    stats.visit_splats_max = std::max<std::uint64_t>(stats.visit_splats_max, part.run.size());
  }
}

// Calls seen(slot) for each splat that is blended.
template <class Seen>
void blend_run(Part& part, StreamingStats& stats, const Seen& seen) {
  for (const Splat& splat : part.run) {
    if (part.state.saturated()) return;
    const auto observe = [&](const SubtileBlend& blend) {
      if (part.watch.see(blend, splat.depth)) seen(splat.index);
    };
    stats.subtile_blends += part.state.blend(splat, observe).blended;
  }
}

// One group's visits, in their order.
void render_group(const View<float>& view, const ActivatedCloud& cloud, const VoxelGrid& grid,
                  const PaperOrderConfig& config, const std::vector<std::uint32_t>& voxels,
                  std::vector<Part>& parts, Flags& contributing, StreamingStats& stats) {
  for (const std::uint32_t voxel : voxels) {
    if (all_saturated(parts)) {
      ++stats.visits_saturated;
      continue;
    }
    const auto plane = [&](std::uint32_t at) { return grid.cuts[at]; };
    const auto visit = [&](const VoxelRecord& piece) {
      ++stats.visits;
      filter_and_sort(view, cloud, piece, config, parts, stats);
      for (Part& part : parts) {
        blend_run(part, stats, [&](std::uint32_t slot) { contributing.set(slot); });
      }
      return !all_saturated(parts);
    };
    visit_pieces(grid.voxels[voxel], view.position, config.visit_gaussians, plane, visit);
  }
}

}  // namespace

GroupVisits paper_visits(const View<float>& view, const PixelRect& group, const VoxelGrid& grid,
                         const RayPattern& rays, OrderingTable& table) {
  if (grid.nodes.empty()) return {};
  const GridTable nodes{grid};
  if (rays.by_coordinates) {
    const SampleSpace space = sample_space(view.position, grid.frame, occupied_cells(grid),
                                           rays.sample_step_voxels, rays.sample_far_voxels);
    RaysInRounds rounds(view, rays, CellSamplePath(grid.frame, space), nodes);
    return group_visits(group, rounds, table);
  }
  if (rays.sample_step_voxels > 0) {
    RaysInRounds rounds(view, rays, SamplePath(grid.frame, rays.sample_step_voxels), nodes);
    return group_visits(group, rounds, table);
  }
  RaysInRounds rounds(view, rays, RayPath<float>(grid.frame), nodes);
  return group_visits(group, rounds, table);
}

std::vector<std::vector<std::uint32_t>> visited_voxels(const View<float>& view,
                                                       const VoxelGrid& grid,
                                                       const PaperOrderConfig& config) {
  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, config.group);
  std::vector<std::vector<std::uint32_t>> out(groups.size());
  tbb::enumerable_thread_specific<OrderingTable> tables(grid.voxels.size(), config.table_bytes,
                                                        config.line_destinations);
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t group) {
    out[group] = paper_visits(view, groups[group], grid, config.rays, tables.local()).voxels;
  });
  return out;
}

StreamingResult render_paper_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const VoxelGrid& grid, const PaperOrderConfig& config) {
  StreamingResult out;
  out.frame = RenderResult(view.width, view.height);

  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, config.group);
  const std::vector<std::vector<PixelRect>> parts_of_groups =
      group_parts(groups, config.group, config.parts);
  const MissedSplats missed(view, cloud, grid, config.group);
  std::vector<StreamingStats> stats(groups.size());
  out.group_voxels.resize(groups.size());
  Flags contributing(cloud.size()), reached(grid.voxels.size());
  tbb::enumerable_thread_specific<OrderingTable> tables(grid.voxels.size(), config.table_bytes,
                                                        config.line_destinations);
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t index) {
    const PixelRect& group = groups[index];
    StreamingStats& s = stats[index];
    GroupVisits visits = paper_visits(view, group, grid, config.rays, tables.local());
    s.groups = 1;
    s.ray_steps = visits.steps;
    s.edges_offered = visits.edges_offered;
    s.table_bytes_max = visits.table_bytes;
    for (const std::uint32_t voxel : visits.voxels) reached.set(voxel);
    s.missed = missed.count(index, visits.voxels);

    std::vector<Part> parts;
    for (const auto& part : parts_of_groups) parts.emplace_back(part[index], view, config);
    render_group(view, cloud, grid, config, visits.voxels, parts, contributing, s);
    for (const Part& part : parts) {
      s.misordered += part.watch.misordered();
      s.contributors += part.state.contributors();
      part.state.store(config.background, out.frame);
    }
    out.group_voxels[index] = std::move(visits.voxels);
  });
  for (const StreamingStats& s : stats) out.stats += s;
  out.stats.contributing = contributing.count();
  out.stats.blocks_reached = reached.count();
  out.of_groups = std::move(stats);
  return out;
}

}  // namespace sgs
