// The visits of one pixel group in paper order, as the voxel sorting unit (VSU) finds them: the
// occupied voxels that its rays cross, in an order that respects every ray (StreamingGS, DAC 2025).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/ray_path.h"
#include "algorithm/voxel/ray_sampling.h"

namespace sgs {

// Which rays of a group are followed, and how.
struct RayPattern {
  // Rays of every so-many-th pixel in either direction, and of the last row and column.
  std::uint32_t step_px = 1;
  float sample_step_voxels = 0;    // 0: every cell of the ray; else the distance of samples on it
  float sample_far_voxels = 0;     // by_coordinates: length of a ray; 0: to the end of the box
  std::uint32_t side_by_side = 1;  // rays that are followed at a time
  bool by_coordinates = false;     // the samples' own cells (cell_samples.h), not down the tree
};

struct GroupVisits {
  std::vector<std::uint32_t> voxels;  // visiting order
  std::uint64_t rays = 0;             // followed, those of passes that overflowed included
  std::uint64_t steps = 0;            // blocks crossed or samples taken
  std::uint64_t edges_offered = 0;    // consecutive pairs over all rays
  std::uint64_t table_bytes = 0;      // ordering table at its fullest
  std::uint64_t passes = 0;           // passes that were ordered
  std::uint64_t overflows = 0;        // passes begun again because the table was full
};

// Voxels by distance from the eye, those of one distance by index: a number that rises along every
// ray, so that whatever is visited window after window is in order.
class VisitWindow {
 public:
  static std::uint64_t place(std::uint32_t voxel, std::uint32_t cells_from_eye) {
    return std::uint64_t{cells_from_eye} << 32U | voxel;
  }
  static std::uint32_t voxel(std::uint64_t place) { return static_cast<std::uint32_t>(place); }
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

// The pixels of a group whose rays are followed, row by row.
class RayPixels {
 public:
  RayPixels(const PixelRect& group, std::uint32_t step_px)
      : group_(group), step_px_(step_px), x_(group.x0), y_(group.y0) {}

  bool done() const { return y_ == group_.y1; }
  int x() const { return x_; }
  int y() const { return y_; }
  void next() {
    x_ = next_ray(x_, group_.x1, step_px_);
    if (x_ < group_.x1) return;
    x_ = group_.x0;
    y_ = next_ray(y_, group_.y1, step_px_);
  }

 private:
  PixelRect group_;
  std::uint32_t step_px_;
  int x_, y_;
};

// One pass over the rays of a group, without any time. So many are followed side by side, in
// rounds: in each round each goes on to the end of its next step, in turn, and where one has ended
// the group's next ray takes its place in the round after. So the order in which voxels are met
// does not depend on how long a ray's step takes, and no ray gets far ahead of another. Path:
// RayPath or SamplePath.
template <class Path, class Table>
class RaysInRounds {
 public:
  RaysInRounds(const View<float>& view, const RayPattern& rays, const Path& path, Table& nodes)
      : view_(view),
        step_px_(rays.step_px),
        places_(rays.side_by_side, Place{path}),
        nodes_(nodes) {}

  // Enters the voxels of the window that the rays meet. Returns false as soon as the table is full.
  bool follow(const PixelRect& group, VisitWindow& window, OrderingTable& table, GroupVisits& out) {
    RayPixels pixels(group, step_px_);
    for (Place& place : places_) begin(place, pixels, out);
    for (bool any = true; any;) {
      any = false;
      for (Place& place : places_) {
        if (!place.taken) continue;
        any = true;
        switch (go_on(place, window, table)) {
          case Round::kStep:
            ++out.steps;
            break;
          case Round::kEnd:
            begin(place, pixels, out);
            break;
          case Round::kFull:
            return false;
        }
      }
    }
    return true;
  }
  void ordered(const std::vector<std::uint32_t>&, const OrderingTable&, bool) {}

 private:
  enum class Round : std::uint8_t { kStep, kEnd, kFull };
  struct Place {
    Path path;
    OrderingTable::Chain chain = {};
    bool taken = false;
  };

  void begin(Place& place, RayPixels& pixels, GroupVisits& out) {
    place.taken = !pixels.done();
    if (!place.taken) return;
    place.path.begin(pixel_ray(view_, pixels.x(), pixels.y()));
    place.chain = {};
    pixels.next();
    ++out.rays;
    ++out.steps;
  }

  Round go_on(Place& place, VisitWindow& window, OrderingTable& table) {
    while (true) {
      const RayEventOf event = place.path.next();
      switch (event.what) {
        case RayEvent::kLookUp:
          place.path.give(nodes_.node(event.index));
          break;
        case RayEvent::kVoxel: {
          const std::uint64_t at = VisitWindow::place(event.index, event.cells);
          if (window.behind(at)) return Round::kEnd;
          if (window.before(at)) break;
          window.meet(at);
          if (!table.add(place.chain, event.index)) return Round::kFull;
          break;
        }
        case RayEvent::kStep:
          return Round::kStep;
        case RayEvent::kEnd:
          return Round::kEnd;
      }
    }
  }

  const View<float>& view_;
  const std::uint32_t step_px_;
  std::vector<Place> places_;
  Table& nodes_;
};

// Where the table overflows, the group is ordered in passes: the rays are followed again for the
// nearer half of the voxels met, that for as long as it does not fit, then for the rest. A table
// that holds one voxel is enough for any group, and no voxel is visited twice.
//
// Rays: RaysInRounds, or what takes time and enters what the rays meet in the same order.
// rays.ordered(voxels, table, last) is called with each pass, while the table still holds it.
template <class Rays>
GroupVisits group_visits(const PixelRect& group, Rays& rays, OrderingTable& table) {
  GroupVisits out;
  VisitWindow window;
  while (true) {
    table.clear();
    const bool fits = rays.follow(group, window, table, out);
    out.edges_offered += table.edges_offered();
    if (!fits) {
      ++out.overflows;
      window = window.nearer_half();
      continue;
    }
    out.table_bytes = std::max(out.table_bytes, table.bytes());
    const std::vector<std::uint32_t> voxels = table.order();
    out.voxels.insert(out.voxels.end(), voxels.begin(), voxels.end());
    ++out.passes;
    rays.ordered(voxels, table, window.last());
    if (window.last()) return out;
    window = window.rest();
  }
}

}  // namespace sgs
