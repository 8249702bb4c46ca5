// Can any Gaussian of a chunk change a pixel of a group, and how near can the nearest one be?
//
// A splat is blended no farther from its centre x than half_x <= F k sqrt(cov_a) + 0.02 px along x
// (footprint.h), where F covers the widening for rounding, cov_a = |u1|^2 + 0.3 and
// u1 = (fx / v_z) M^T n with n = axis_x - u axis_z, axes the rows of R^T and u = clamp(v_x / v_z).
// With E the largest visible half-extents k sqrt(Sigma_aa) along the world's axes,
// k |M^T n| <= sum_a |n_a| E_a, and sqrt(A + B) <= sqrt(A) + sqrt(B). So x + half_x >= x0, times
// v_z:
//   fx v_x + (cx - x0 + c) v_z + F fx sum_a |n_a| E_a >= 0,   c = F k_max sqrt(0.3) + 0.02,
// whose first part is linear in the centre: its maximum over the box of centres is at a corner. The
// other three sides are alike.
// F: with lambda <= (f S stretch / v_z)^2 (1 + u^2 + w^2) + 0.3 and S the largest scale, the
// condition of the 2D covariance is at most 13.4 lambda (coarse_bound.h); while the widening is
// below its limit F = sqrt(1 + widening). Beyond, the footprint is only cut to tiles: half_x <=
// ceil(3 sqrt(lambda + sqrt(0.1))) + 16, which has the same form with 3 f S stretch sqrt(1 + u^2 +
// w^2) in place of the sum. Rounding: a Gaussian's v is off by at most 5 eps sum_a |axis_a| |p_a -
// c_a|, its pixel position by that times fx / v_z and 4 eps |x|; the test itself loses as much
// again. 64 eps (fx + |cx - x0| + c) sum_a |p_a - c_a|, taken at the far corner of the box, covers
// both. It is needed where fx eps reaches a pixel: exact_renderer_test.cpp has frames that lose
// pixels without it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_node.h"

namespace sgs {

struct ChunkTest {
  bool touches;   // false: no Gaussian of the chunk changes a pixel of the group
  float nearest;  // no Gaussian of the chunk that is in front has a smaller computed v_z
};

class GroupFrustum {
 public:
  GroupFrustum(const View<float>& view, const PixelRect& pixels) : view_(view), pixels_(pixels) {}

  ChunkTest test(const ChunkBound& bound) const;

 private:
  // One side of the group: a point passes when direction . v >= 0 in the camera frame.
  bool beyond_side(const glm::vec3& centre, const glm::vec3& half, int axis, float sign,
                   float edge_px, float padding_px, float reach, float rounding) const;

  const View<float>& view_;
  PixelRect pixels_;
};

}  // namespace sgs
