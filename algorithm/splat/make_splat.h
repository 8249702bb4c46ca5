// From a Gaussian to a splat: what the fine filter computes for each survivor of the coarse filter.
#pragma once

#include <cstdint>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// The geometric part. False where nothing of g can be seen in the frame: behind the near plane,
// never visible, off the frame, or a centre or covariance that overflows float (a splat farther or
// wider than 10^19 px). p: what of the projection a splat does not keep.
template <class T>
bool make_geometry(const View<T>& view, const Gaussian<T>& g, SplatOf<T>& out, Projected<T>& p) {
  const glm::vec<3, T> v = to_camera(view, g.mean);
  if (!(v.z > constant<T>(kNearPlane))) return false;
  p = project(view, g, v);
  using std::isfinite;
  if (!isfinite(T(p.cov_a + p.cov_c)) || !isfinite(T(p.x + p.y))) return false;
  if (!isfinite(p.depth)) return false;  // nothing can be in order with it
  out.x = p.x;
  out.y = p.y;
  out.conic_a = p.conic_a;
  out.conic_b = p.conic_b;
  out.conic_c = p.conic_c;
  out.opacity = g.opacity;
  out.depth = p.depth;
  out.footprint = footprint(p, g.opacity, view.width, view.height);
  return !out.footprint.empty();
}
template <class T>
bool make_geometry(const View<T>& view, const Gaussian<T>& g, SplatOf<T>& out) {
  Projected<T> p;
  return make_geometry(view, g, out, p);
}

// Pixels of a footprint, cut to `within`.
template <class Short>
auto footprint_px(const SubtileRectOf<Short>& footprint, const PixelRect& within) {
  using Index = decltype(footprint.x0 * kSubtilePx);
  return intersection(PixelRectOf<Index>{footprint.x0 * kSubtilePx, footprint.y0 * kSubtilePx,
                                         footprint.x1 * kSubtilePx, footprint.y1 * kSubtilePx},
                      {within.x0, within.y0, within.x1, within.y1});
}

// True if a splat can change a pixel of the group `pixels`: its footprint overlaps and so does its
// visible ellipse.
template <class T>
bool reaches_group(const SplatOf<T>& s, const PixelRect& pixels) {
  const auto overlap = footprint_px(s.footprint, pixels);
  return !overlap.empty() &&
         reaches(s.x, s.y, s.conic_a, s.conic_b, s.conic_c, visible_cutoff(s.opacity), overlap);
}

template <class T>
void add_colour(const View<T>& view, int sh_degree, const glm::vec<3, T>& mean,
                const glm::vec<3, T>* sh, SplatOf<T>& out) {
  out.rgb = sh_colour(sh_degree, sh, sight(view, mean));
}

}  // namespace sgs
