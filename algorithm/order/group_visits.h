// What the voxel sorting unit (VSU) computes for one pixel group in paper order: the occupied
// voxels that its rays cross, in an order that respects every ray.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/ray_walk.h"

namespace sgs {

// Which rays of a group are followed, and how.
struct RayPattern {
  // Rays of every so-many-th pixel in either direction, and of the last row and column.
  std::uint32_t step_px = 1;
  float sample_step_voxels = 0;  // 0: every cell of the ray; else the distance of samples on it
};

struct GroupVisits {
  std::vector<std::uint32_t> voxels;  // visiting order
  std::uint64_t rays = 0;             // followed, those of passes that overflowed included
  std::uint64_t steps = 0;            // blocks crossed or samples taken
  std::uint64_t edges_offered = 0;    // consecutive pairs over all rays
  std::uint64_t table_bytes = 0;      // ordering table at its fullest
  std::uint64_t overflows = 0;        // passes begun again because the table was full
};

// Voxels by distance from the eye, those of one distance by index: a number that rises along every
// ray, so that whatever is visited window after window is in order.
class VisitWindow {
 public:
  static std::uint64_t place(std::uint32_t voxel, std::uint32_t cells_from_eye) {
    return std::uint64_t{cells_from_eye} << 32U | voxel;
  }
  bool before(std::uint64_t place) const { return place < begin_; }
  bool behind(std::uint64_t place) const { return place >= end_; }
  bool last() const { return end_ == kEnd; }

  void meet(std::uint64_t place) {
    nearest_ = std::min(nearest_, place);
    farthest_ = std::max(farthest_, place);
  }
  // The nearer half of what was met, which must be two voxels or more.
  VisitWindow nearer_half() const { return {begin_, nearest_ + (farthest_ - nearest_) / 2 + 1}; }
  VisitWindow rest() const { return {end_, kEnd}; }

  VisitWindow() = default;

 private:
  static constexpr std::uint64_t kEnd = std::numeric_limits<std::uint64_t>::max();
  VisitWindow(std::uint64_t begin, std::uint64_t end) : begin_(begin), end_(end) {}

  std::uint64_t begin_ = 0, end_ = kEnd;
  std::uint64_t nearest_ = kEnd, farthest_ = 0;
};

// Coordinates of the rays along one side of a group: begin, begin + step, ..., and the last one.
inline int next_ray(int at, int end, std::uint32_t step_px) {
  if (at == end - 1) return end;
  return static_cast<int>(std::min<std::int64_t>(std::int64_t{at} + step_px, end - 1));
}

// Follows the rays of a group, enters the voxels of a window. Returns false as soon as the table is
// full.
template <class Tracer, class Watch>
bool follow_rays(const View<float>& view, const PixelRect& group, std::uint32_t step_px,
                 Tracer& tracer, VisitWindow& window, OrderingTable& table, Watch& watch,
                 GroupVisits& out) {
  table.clear();
  std::vector<std::uint32_t> chain;
  for (int y = group.y0; y < group.y1; y = next_ray(y, group.y1, step_px)) {
    for (int x = group.x0; x < group.x1; x = next_ray(x, group.x1, step_px)) {
      chain.clear();
      const auto visit = [&](std::uint32_t voxel, std::uint32_t cells) {
        const std::uint64_t place = VisitWindow::place(voxel, cells);
        if (window.behind(place)) return false;
        if (window.before(place)) return true;
        window.meet(place);
        chain.push_back(voxel);
        return true;
      };
      const std::uint32_t steps = tracer.walk(pixel_ray(view, x, y), visit);
      const bool fits = table.add_chain(chain);
      out.steps += steps;
      ++out.rays;
      watch.ray(steps, chain.empty() ? std::size_t{0} : chain.size() - 1);
      if (!fits) return false;
    }
  }
  return true;
}

// Where the table overflows, the group is ordered in passes: the rays are followed again for the
// nearer half of the voxels met, that for as long as it does not fit, then for the rest. A table
// that holds one voxel is enough for any group, and no voxel is visited twice.
//
// Tracer: `std::uint32_t walk(const Ray&, visit)` (RayWalk or RaySampling). watch.ray(steps, edges)
// is called after each ray, watch.full() where the table overflows, watch.ordered(voxels, last)
// with each pass, while the table still holds it; VSU lets simulated time pass there.
template <class Tracer, class Watch>
GroupVisits group_visits(const View<float>& view, const PixelRect& group, std::uint32_t step_px,
                         Tracer& tracer, OrderingTable& table, Watch&& watch) {
  GroupVisits out;
  VisitWindow window;
  while (true) {
    const bool fits = follow_rays(view, group, step_px, tracer, window, table, watch, out);
    out.edges_offered += table.edges_offered();
    if (!fits) {
      ++out.overflows;
      watch.full();
      window = window.nearer_half();
      continue;
    }
    out.table_bytes = std::max(out.table_bytes, table.sram_bytes());
    const std::vector<std::uint32_t> voxels = table.order();
    out.voxels.insert(out.voxels.end(), voxels.begin(), voxels.end());
    watch.ordered(voxels, window.last());
    if (window.last()) return out;
    window = window.rest();
  }
}

}  // namespace sgs
