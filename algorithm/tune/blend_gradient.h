// Blending of one splat into one pixel, differentiated: back to front, with alpha and T as the
// blend pass told them.
//
// A pixel is C = sum_i c_i alpha_i T_i + T_end B with T_i = prod_{j<i} (1 - alpha_j).
// With g = dL/dC,
//   dL/dalpha_i = T_i (g . c_i) - behind_i / (1 - alpha_i),
//   behind_i = sum_{j>i} alpha_j T_j (g . c_j) + T_end (g . B + dL/dT_end),
// the last for a loss that looks at T_end, too.
#pragma once

#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/tune/gradient_rule.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// What one splat means to one pixel.
template <class T>
struct ShareGradient {
  T weight;   // dC/dc = alpha T
  T falloff;  // dL/dpower, power = -d^T conic d / 2; over opacity, it is dL/dopacity
  T behind;   // of the splat in front of this one
};

// alpha: as blended, capped at 0.99, or 0. before: T in front of the splat. toward: g . c. slope:
// dalpha/dpower.
template <class T>
inline ShareGradient<T> share_gradient(T alpha, T before, T toward, T behind, T slope) {
  const T weight = T(alpha * before);
  const T by_alpha = T(before * toward - behind / T(T(1.0F) - alpha));
  return {weight, T(slope * by_alpha), T(behind + weight * toward)};
}

// dalpha/dpower of alpha = min(0.99, opacity exp(power)). uncapped() is opacity exp(power), called
// for kOriginal only.
template <GradientRule kRule, class T, class Uncapped>
inline T slope_of_alpha(T alpha, const Uncapped& uncapped) {
  const bool capped = !(alpha < constant<T>(kAlphaMax));
  if constexpr (kRule == GradientRule::kOriginal) {
    const T slope = uncapped();
    return capped ? slope : alpha;
  } else {
    return capped ? T(0.0F) : alpha;
  }
}

// e = conic d, d = centre of the splat minus pixel: dpower/dx = -e_x, dpower/dcov = e e^T / 2.
template <class T>
struct ConicArm {
  T x, y;
};
template <class T>
inline ConicArm<T> conic_arm(T conic_a, T conic_b, T conic_c, T dx, T dy) {
  return {T(conic_a * dx + conic_b * dy), T(conic_b * dx + conic_c * dy)};
}

// exp(power).
template <class T>
inline T falloff_at(const ConicArm<T>& arm, T dx, T dy) {
  return exp_of(T(T(-0.5F) * T(arm.x * dx + arm.y * dy)));
}

// Sums over pixels of a splat's falloff gradients f and of their products with its arms, and of its
// weights times dL/dC.
template <class T>
struct FalloffMoments {
  T one, x, y, xx, xy, yy, red, green, blue;
};

template <class T>
SplatGradient<T> splat_gradient(const FalloffMoments<T>& sums, T opacity) {
  const T half = T(0.5F);
  SplatGradient<T> out;
  out.x = T(-sums.x);
  out.y = T(-sums.y);
  out.cov_a = T(half * sums.xx);
  out.cov_b = sums.xy;
  out.cov_c = T(half * sums.yy);
  out.opacity = T(sums.one / opacity);
  out.rgb = {sums.red, sums.green, sums.blue};
  return out;
}

}  // namespace sgs
