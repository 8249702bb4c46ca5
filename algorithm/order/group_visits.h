// What the voxel sorting unit (VSU) computes for one pixel group in paper order: the occupied
// voxels that its rays cross, in an order that respects every ray.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/ray_walk.h"

namespace sgs {

struct GroupVisits {
  std::vector<std::uint32_t> voxels;  // visiting order
  std::uint64_t rays = 0;
  std::uint64_t steps = 0;          // nodes looked into, blocks crossed or samples taken
  std::uint64_t edges_offered = 0;  // consecutive pairs over all rays
  std::uint64_t table_bytes = 0;    // ordering table at its fullest
};

// Tracer: `std::uint32_t walk(const Ray&, visit)` (RayWalk or RaySampling). on_ray(steps, edges) is
// called after each ray; VSU lets simulated time pass there.
template <class Tracer, class OnRay>
GroupVisits group_visits(const View<float>& view, const PixelRect& group, Tracer& tracer,
                         OrderingTable& table, OnRay&& on_ray) {
  GroupVisits out;
  table.clear();
  std::vector<std::uint32_t> chain;
  for (int y = group.y0; y < group.y1; ++y) {
    for (int x = group.x0; x < group.x1; ++x) {
      chain.clear();
      const std::uint32_t steps =
          tracer.walk(pixel_ray(view, x, y), [&](std::uint32_t voxel) { chain.push_back(voxel); });
      table.add_chain(chain);
      out.steps += steps;
      ++out.rays;
      on_ray(steps, chain.empty() ? std::size_t{0} : chain.size() - 1);
    }
  }
  out.voxels = table.order();
  out.edges_offered = table.edges_offered();
  out.table_bytes = table.sram_bytes();
  return out;
}

}  // namespace sgs
