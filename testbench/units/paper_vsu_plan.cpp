// The visits of every group and the cycles of its rays, without the unit.
#include "testbench/units/paper_vsu_plan.h"

#include <algorithm>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/lane_macs.h"
#include "algorithm/voxel/ray_work.h"
#include "algorithm/voxel/voxel_cuts.h"
#include "testbench/units/ray_timing_model.h"

namespace sgs::tb {
namespace {

// What the rays of a group do, from the grid itself.
template <class Path>
std::vector<RayEvents> events_of(const PaperVsuPlan& plan, const PixelRect& group, Path path) {
  std::vector<RayEvents> rays;
  for (RayPixels at(group, plan.config.ray_step_px); !at.done(); at.next()) {
    RayEvents& events = rays.emplace_back();
    path.begin(pixel_ray(plan.scene.job.view, at.x(), at.y()));
    do {
      events.push_back(path.next());
      if (events.back().what == RayEvent::kLookUp) {
        path.give(plan.scene.grid.nodes[events.back().index]);
      }
    } while (events.back().what != RayEvent::kEnd);
  }
  return rays;
}
std::vector<RayEvents> events_of(const PaperVsuPlan& plan, const PixelRect& group) {
  const RayPattern rays = plan.config.rays();
  const VoxelFrame& frame = plan.scene.grid.frame;
  if (rays.sample_step_voxels > 0) {
    return events_of(plan, group, SamplePath(frame, rays.sample_step_voxels));
  }
  return events_of(plan, group, RayPath<float>(frame));
}

std::uint64_t count_of(const std::vector<RayEvents>& rays, RayEvent what) {
  std::uint64_t sum = 0;
  for (const RayEvents& ray : rays) {
    sum += static_cast<std::uint64_t>(std::count_if(
        ray.begin(), ray.end(), [&](const RayEventOf& event) { return event.what == what; }));
  }
  return sum;
}

// Kahn's algorithm, which uses the table up; beside it the names are cleared, four a cycle.
std::uint64_t ordering_cycles(const PaperVsuPlan& plan, OrderingTable& table) {
  const std::uint64_t clearing =
      Renaming::slots_for(OrderingTable::most_voxels(plan.config.table_bytes)) / 4;
  const std::uint64_t before = table.accesses().cycles;
  table.order();
  return std::max(clearing, table.accesses().cycles - before);
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

std::uint64_t macs_of_a_step() { return folded_macs(ray_step_work(longest_step_case())); }
std::uint64_t macs_of_a_beginning() { return folded_macs(pixel_ray_work()); }

std::uint64_t comparisons_of_a_step() { return comparisons(ray_step_work(longest_step_case())); }
std::uint64_t comparisons_of_a_beginning() { return comparisons(pixel_ray_work()); }

ExpectedVisits expect(const PaperVsuPlan& plan, std::uint64_t latency) {
  ExpectedVisits out;
  const VoxelGrid& grid = plan.scene.grid;
  OrderingTable table(grid.voxels.size(), plan.config.table_bytes, plan.config.table_banks);
  RayTimingModel model(plan.config, latency, plan.scene.job.layout.voxel_table().nodes);
  for (const PixelRect& group : plan.scene.job.groups) {
    const RayPattern rays = plan.config.rays();
    const GroupVisits visits = paper_visits(plan.scene.job.view, group, grid, rays, table);
    out.passes += grid.nodes.empty() ? 1 : visits.passes;
    if (!grid.nodes.empty()) {
      const std::vector<RayEvents> events = events_of(plan, group);
      out.lookups += count_of(events, RayEvent::kLookUp);
      out.met += count_of(events, RayEvent::kVoxel);
      table.clear();
      if (visits.overflows == 0) {
        const OrderingAccesses before = table.accesses();
        const RayTimingModel::Times times = model.pass(events, table);
        const std::uint64_t ordering = ordering_cycles(plan, table);
        add_difference(before, table.accesses(), out.table);
        ++out.orderings;
        out.traverse_cycles += times.all - times.waits + ordering;
        if (out.groups.empty()) out.first_group_cycles = times.all + ordering;
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
  out.lookups_again = model.look_ups_again();
  out.lookups_missed = model.look_ups_missed();
  return out;
}

}  // namespace sgs::tb
