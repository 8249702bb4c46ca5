// The comparison, Gaussian by Gaussian, then along the float order.
#include "tests/algorithm/render/decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/footprint.h"
#include "testbench/oracle/double_oracle.h"
#include "tests/algorithm/render/tracked_projection.h"

namespace sgs::test {
namespace {

// Tile indices that rounding leaves open for one edge of the rectangle.
struct EdgeRange {
  int low, high;
  bool holds(int tile) const { return low <= tile && tile <= high; }
};
EdgeRange edge_range(Tracked px, int tiles) {
  // Double is not exact either: 1e-12 of the value covers the oracle's own rounding.
  const double slack = px.error + 1e-12 * std::abs(px.value);
  return {truncated_index((px.value - slack) / 16, tiles),
          truncated_index((px.value + slack) / 16, tiles)};
}

class Comparison {
 public:
  Comparison(const Camera& camera, const GaussianCloud& cloud)
      : camera_(camera),
        cloud_(cloud),
        activated_(activate(cloud)),
        view_(make_view<float>(camera)),
        tracked_view_(tracked_view(camera)),
        oracle_(oracle_project(camera, cloud)) {}

  Decisions run() {
    out_.in_front = oracle_.size();
    auto next = oracle_.begin();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const bool in_double = next != oracle_.end() && next->index == i;
      compare_one(i, in_double ? &*next : nullptr);
      if (in_double) ++next;
    }
    compare_order();
    return out_;
  }

 private:
  struct Ordered {
    float depth;  // float renderer's key
    std::uint32_t index;
    float oracle_key;  // double v_z as float
    Tracked tracked_depth;
  };

  void unexplained(std::size_t i, const std::string& what) {
    if (out_.unexplained++ == 0) out_.first_unexplained = fmt::format("Gaussian {}: {}", i, what);
  }

  void check_value(std::size_t i, const char* name, float in_float, double in_double,
                   const Tracked& bound) {
    const double error = std::abs(in_float - in_double);
    const double most = bound.error + 1e-12 * std::abs(in_double);
    out_.worst_share = std::max(out_.worst_share, error / most);
    if (!(error <= most)) {
      unexplained(i, fmt::format("{} {} in float, {} in double, bound {}", name, in_float,
                                 in_double, most));
    }
  }

  void compare_one(std::size_t i, const OracleSplat* oracle) {
    const Gaussian<float>& g = activated_.gaussians[i];
    const auto v = to_camera(view_, g.mean);
    const Gaussian<Tracked> tracked = tracked_gaussian(cloud_, i);
    const auto tracked_v = to_camera(tracked_view_, tracked.mean);
    const bool in_float = v.z > constant<float>(kNearPlane);
    if (in_float != (oracle != nullptr)) {
      ++out_.near_plane;
      const Tracked plane = rounded(kNearPlane);
      if (std::abs(tracked_v.z.value - plane.value) > tracked_v.z.error + plane.error) {
        unexplained(i, fmt::format("near plane at depth {}", tracked_v.z.value));
      }
    }
    if (!in_float || oracle == nullptr) return;
    const auto p = project(view_, g, v);
    const auto bound = project(tracked_view_, tracked, tracked_v);
    check_value(i, "x", p.x, oracle->x, bound.x);
    check_value(i, "y", p.y, oracle->y, bound.y);
    check_value(i, "depth", p.depth, oracle->depth, bound.depth);
    compare_rects(i, p, *oracle, bound);
  }

  void compare_rects(std::size_t i, const Projected<float>& p, const OracleSplat& oracle,
                     const Projected<Tracked>& bound) {
    const PixelRect tiles = tile_rect(p.x, p.y, p.radius, camera_.width, camera_.height);
    const int tiles_x = (camera_.width + 15) / 16, tiles_y = (camera_.height + 15) / 16;
    const Tracked last(15.0F);
    const EdgeRange ranges[4] = {edge_range(bound.x - bound.radius, tiles_x),
                                 edge_range(bound.y - bound.radius, tiles_y),
                                 edge_range(bound.x + bound.radius + last, tiles_x),
                                 edge_range(bound.y + bound.radius + last, tiles_y)};
    const int in_float[4] = {tiles.x0, tiles.y0, tiles.x1, tiles.y1};
    const int in_double[4] = {oracle.x0, oracle.y0, oracle.x1, oracle.y1};
    const auto empty = [](const int(&r)[4]) { return r[2] <= r[0] || r[3] <= r[1]; };
    if (empty(in_float) && empty(in_double)) return;

    bool differs = false, uncertain = false;
    for (int edge = 0; edge < 4; ++edge) {
      differs = differs || in_float[edge] != in_double[edge];
      uncertain = uncertain || ranges[edge].low != ranges[edge].high;
      if (!ranges[edge].holds(in_float[edge]) || !ranges[edge].holds(in_double[edge])) {
        unexplained(i, fmt::format("edge {} at tile {} in float, {} in double", edge,
                                   in_float[edge], in_double[edge]));
      }
    }
    out_.rect_differs += differs;
    out_.rect_uncertain += uncertain;
    if (!empty(in_float) && !empty(in_double)) {
      ordered_.push_back({p.depth, oracle.index, oracle.depth_key, bound.depth});
    }
  }

  // Along the float order the double keys must rise too, except where rounding can turn two round.
  void compare_order() {
    std::sort(ordered_.begin(), ordered_.end(), [](const Ordered& a, const Ordered& b) {
      return a.depth < b.depth || (a.depth == b.depth && a.index < b.index);
    });
    std::pair<float, std::uint32_t> farthest{0.0F, 0};
    double surely_behind = 0;  // the largest depth that an earlier splat has at least
    for (const Ordered& s : ordered_) {
      const std::pair<float, std::uint32_t> key{s.oracle_key, s.index};
      if (key < farthest) {
        ++out_.order_differs;
        // The key is the double depth rounded once more.
        const double half_ulp = 0x1p-24 * s.oracle_key;
        if (s.tracked_depth.high() + 2 * half_ulp < surely_behind) {
          unexplained(s.index, fmt::format("order at depth {}", s.tracked_depth.value));
        }
      }
      farthest = std::max(farthest, key);
      surely_behind = std::max(surely_behind, s.tracked_depth.low());
    }
  }

  const Camera& camera_;
  const GaussianCloud& cloud_;
  const ActivatedCloud activated_;
  const View<float> view_;
  const View<Tracked> tracked_view_;
  const std::vector<OracleSplat> oracle_;
  std::vector<Ordered> ordered_;
  Decisions out_;
};

}  // namespace

Decisions compare_decisions(const Camera& camera, const GaussianCloud& cloud) {
  return Comparison(camera, cloud).run();
}

}  // namespace sgs::test
