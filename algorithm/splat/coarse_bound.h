// The coarse filter: can a Gaussian, of which only the centre and the largest scale are known,
// touch a rectangle of pixels?
//
// With J the Jacobian at the clamped centre, |J|^2 <= (f/v_z)^2 (1 + u^2 + w^2), f = max(fx, fy),
// and |R^T| <= stretch, so the largest eigenvalue of the 2D covariance is at most
//   lambda = (f stretch scale_max / v_z)^2 (1 + u^2 + w^2) + 0.3.
// A splat is visible within kVisibleSigmas sqrt(lambda) of its centre (opacity at most 1), widened
// as in footprint.h with kappa <= (2 lambda)^2 / (0.3 lambda), since det >= 0.3 lambda. It is also
// cut to the tiles that the square of half-size `radius` touches: at most 16 px beyond that. The
// lambda of the radius is mid + sqrt(max(0.1, mid^2 - det)) <= lambda + sqrt(0.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct CoarseBound {
  bool in_front;    // v_z > near plane
  float depth;      // v_z
  float x, y;       // px
  float reach_px;   // nothing is blended farther from the centre (Euclidean)
  float square_px;  // nor farther along either axis
};

inline CoarseBound coarse_bound(const View<float>& view, const glm::vec3& mean, float scale_max) {
  CoarseBound out{};
  const glm::vec3 v = to_camera(view, mean);
  out.depth = v.z;
  out.in_front = v.z > constant<float>(kNearPlane);
  if (!out.in_front) return out;
  const auto pixel = to_pixel(view, v);
  out.x = pixel.x;
  out.y = pixel.y;
  const auto [u, w] = clamped_ratio(view, v);
  const float spread = std::max(view.focal_x, view.focal_y) * view.stretch * (scale_max / v.z);
  // 1e-5: the covariance of projection.h is a sum of squares, exact to a few units in the last
  // place.
  const float lambda =
      (spread * spread * (1 + u * u + w * w) + constant<float>(kLowPass)) * 1.00001F;
  const float sigma = std::sqrt(lambda);
  const float widening = ellipse_widening(4 / constant<float>(kLowPass) * lambda);
  constexpr float kSlackPx = 0.05F;
  out.reach_px = widening < kMaxWidening
                     ? constant<float>(kVisibleSigmas) * sigma * (1.0002F + widening) + kSlackPx
                     : std::numeric_limits<float>::max();
  constexpr float kRadiusExtra = 0.3163F;  // sqrt(kMinDiscriminant), rounded up
  out.square_px =
      constant<float>(kRadiusSigmas) * std::sqrt(lambda + kRadiusExtra) * 1.00001F + 1 + kTilePx;
  return out;
}

// Whether the bound touches a rectangle of pixels.
inline bool touches(const CoarseBound& bound, const PixelRect& pixels) {
  const auto outside = [](float at, int low, int high) {
    return std::max({static_cast<float>(low) - at, at - static_cast<float>(high - 1), 0.0F});
  };
  const float dx = outside(bound.x, pixels.x0, pixels.x1);
  const float dy = outside(bound.y, pixels.y0, pixels.y1);
  return std::max(dx, dy) <= bound.square_px &&
         dx * dx + dy * dy <= bound.reach_px * bound.reach_px;
}

}  // namespace sgs
