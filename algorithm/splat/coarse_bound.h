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

#include <limits>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/view.h"

namespace sgs {

template <class T>
struct CoarseBoundOf {
  bool in_front;  // v_z > near plane
  T depth;        // v_z
  T x, y;         // px
  T reach_px;     // nothing is blended farther from the centre (Euclidean)
  T square_px;    // nor farther along either axis
};
using CoarseBound = CoarseBoundOf<float>;

template <class T>
CoarseBoundOf<T> coarse_bound(const View<T>& view, const glm::vec<3, T>& mean, T scale_max) {
  CoarseBoundOf<T> out{};
  const glm::vec<3, T> v = to_camera(view, mean);
  out.depth = v.z;
  out.in_front = v.z > constant<T>(kNearPlane);
  if (!out.in_front) return out;
  const auto pixel = to_pixel(view, v);
  out.x = pixel.x;
  out.y = pixel.y;
  const auto [u, w] = clamped_ratio(view, v);
  const T spread = T(max_of(view.focal_x, view.focal_y) * view.stretch * T(scale_max / v.z));
  // 1e-5: the covariance of projection.h is a sum of squares, exact to a few units in the last
  // place.
  const T lambda =
      T(T(spread * spread * T(T(1.0F) + u * u + w * w) + constant<T>(kLowPass)) * T(1.00001F));
  const T sigma = sqrt_of(lambda);
  const T widening = ellipse_widening(T(T(4.0F) / constant<T>(kLowPass) * lambda));
  const T slack_px = T(0.05F);
  out.reach_px = widening < T(kMaxWidening)
                     ? T(constant<T>(kVisibleSigmas) * sigma * T(T(1.0002F) + widening) + slack_px)
                     : T(std::numeric_limits<float>::max());
  const T radius_extra = T(0.3163F);  // sqrt(kMinDiscriminant), rounded up
  out.square_px = T(constant<T>(kRadiusSigmas) * sqrt_of(T(lambda + radius_extra)) * T(1.00001F) +
                    T(1.0F) + constant<T>(kTilePx));
  return out;
}

// Whether the bound touches a rectangle of pixels.
template <class T>
bool touches(const CoarseBoundOf<T>& bound, const PixelRect& pixels) {
  const auto outside = [](T at, int low, int high) {
    const T before = T(T(static_cast<float>(low)) - at);
    const T behind = T(at - T(static_cast<float>(high - 1)));
    return max_of(max_of(before, behind), T(0.0F));
  };
  const T dx = outside(bound.x, pixels.x0, pixels.x1);
  const T dy = outside(bound.y, pixels.y0, pixels.y1);
  return max_of(dx, dy) <= bound.square_px &&
         T(dx * dx + dy * dy) <= T(bound.reach_px * bound.reach_px);
}

}  // namespace sgs
