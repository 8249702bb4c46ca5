// The visits of every group and what its rays do, without the unit.
#include "testbench/units/paper_vsu_plan.h"

#include <algorithm>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/voxel/cell_samples.h"
#include "algorithm/voxel/ray_path.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs::tb {
namespace {

// Counts the events of a group's rays, from the grid itself.
template <class Path>
void count_events(const PaperVsuPlan& plan, const PixelRect& group, Path path,
                  ExpectedVisits& out) {
  for (RayPixels at(group, plan.config.ray_step_px); !at.done(); at.next()) {
    path.begin(pixel_ray(plan.scene.job.view, at.x(), at.y()));
    for (RayEventOf event = path.next(); event.what != RayEvent::kEnd; event = path.next()) {
      out.met += event.what == RayEvent::kVoxel ? 1 : 0;
      if (event.what != RayEvent::kLookUp) continue;
      ++out.lookups;
      path.give(plan.scene.grid.nodes[event.index]);
    }
  }
}
void count_events(const PaperVsuPlan& plan, const PixelRect& group, ExpectedVisits& out) {
  const RayPattern rays = plan.config.rays();
  const VoxelFrame& frame = plan.scene.grid.frame;
  if (rays.by_coordinates) {
    const SampleSpace space =
        sample_space(plan.scene.job.view.position, frame, occupied_cells(plan.scene.grid),
                     rays.sample_step_voxels, rays.sample_far_voxels);
    count_events(plan, group, CellSamplePath(frame, space), out);
  } else if (rays.sample_step_voxels > 0) {
    count_events(plan, group, SamplePath(frame, rays.sample_step_voxels), out);
  } else {
    count_events(plan, group, RayPath<float>(frame), out);
  }
}

void add_difference(const OrderingAccesses& before, const OrderingAccesses& after,
                    OrderingAccesses& sum) {
  for (const auto count : {&OrderingAccesses::reads, &OrderingAccesses::writes,
                           &OrderingAccesses::names_read, &OrderingAccesses::names_written,
                           &OrderingAccesses::ready_read, &OrderingAccesses::ready_written}) {
    sum.*count += after.*count - before.*count;
  }
}

}  // namespace

PaperVsuPlan paper_vsu_plan_of(TestScene scene) {
  PaperVsuPlan plan;
  plan.scene = std::move(scene);
  plan.config.table_bytes = 1U << 20U;
  plan.config.visit_gaussians = 0;
  plan.config.step_depth_cycles = 36;
  plan.config.cell_step_depth_cycles = 8;
  plan.config.ray_depth_cycles = 81;
  return plan;
}

std::uint64_t macs_of_a_step() { return folded_macs(ray_step_flow(longest_step_case()).counts()); }
std::uint64_t macs_of_a_beginning() { return folded_macs(pixel_ray_flow().counts()); }

std::uint64_t macs_of_a_sampled_beginning() { return folded_macs(sampled_ray_flow().counts()); }

std::uint64_t macs_of_a_sample() { return folded_macs(ray_sample_flow().counts()); }

std::uint64_t comparisons_of_a_step() {
  return ray_step_flow(longest_step_case()).counts().comparisons;
}
std::uint64_t comparisons_of_a_beginning() { return pixel_ray_flow().counts().comparisons; }

ExpectedVisits expect(const PaperVsuPlan& plan) {
  ExpectedVisits out;
  const VoxelGrid& grid = plan.scene.grid;
  OrderingTable table(grid.voxels.size(), plan.config.table_bytes, plan.config.line_destinations());
  for (const PixelRect& group : plan.scene.job.groups) {
    const RayPattern rays = plan.config.rays();
    const OrderingAccesses before = table.accesses();
    const GroupVisits visits = paper_visits(plan.scene.job.view, group, grid, rays, table);
    out.passes += grid.nodes.empty() ? 1 : visits.passes;
    if (!grid.nodes.empty()) {
      count_events(plan, group, out);
      if (visits.overflows == 0) {
        add_difference(before, table.accesses(), out.table);
        ++out.orderings;
      }
    }
    std::vector<VoxelRecord> pieces;
    for (const std::uint32_t voxel : visits.voxels) {
      const auto plane = [&](std::uint32_t index) {
        ++out.cuts;
        return grid.cuts[index];
      };
      const auto visit = [&](const VoxelRecord& piece) {
        pieces.push_back(piece);
        return true;
      };
      visit_pieces(grid.voxels[voxel], plan.scene.job.view.position, plan.config.visit_gaussians,
                   plane, visit);
    }
    out.voxels += visits.voxels.size();
    out.visits += pieces.size();
    out.empty += visits.voxels.empty() ? 1 : 0;
    out.rays += visits.rays;
    out.rays_of.push_back(visits.rays);
    out.steps += visits.steps;
    out.edges += visits.edges_offered;
    out.table_bytes_max = std::max(out.table_bytes_max, visits.table_bytes);
    out.overflows += visits.overflows;
    out.groups.push_back(std::move(pieces));
  }
  return out;
}

}  // namespace sgs::tb
