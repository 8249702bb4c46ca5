// The derivatives of a loss with respect to a splat on the screen, from those with respect to the
// pixels that it is blended into.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// The gradient to take where the picture has none, or where the original code takes another.
// kDerivative: that of the picture as it is drawn. kOriginal: what the released code of Kerbl et
// al. 2023 takes for it, which differs in two places: alpha passes its gradient on where it is
// capped at 0.99, and where v_x / v_z or v_y / v_z is clamped in the Jacobian, u = limit v_z is
// held fixed beside v_z.
enum class GradientRule { kDerivative, kOriginal };

// The derivatives by the covariance, not by its inverse, the conic. With e = conic d, each pixel's
// part is a product of components of e. By way of the conic it would be one of components of d,
// which are huge along a needle and would have to cancel.
template <class T>
struct SplatGradient {
  T x{}, y{};                   // centre, 1/px
  T cov_a{}, cov_b{}, cov_c{};  // 1/px^2; cov_b is one number that stands twice in [a b; b c]
  T opacity{};
  glm::vec<3, T> rgb{};

  SplatGradient& operator+=(const SplatGradient& other) {
    x += other.x;
    y += other.y;
    cov_a += other.cov_a;
    cov_b += other.cov_b;
    cov_c += other.cov_c;
    opacity += other.opacity;
    rgb += other.rgb;
    return *this;
  }
};

// Blending of one splat into one pixel, differentiated: back to front, with alpha and T as the
// blend pass told them.
//
// A pixel is C = sum_i c_i alpha_i T_i + T_end B with T_i = prod_{j<i} (1 - alpha_j).
// With g = dL/dC,
//   dL/dalpha_i = T_i (g . c_i) - behind_i / (1 - alpha_i),
//   behind_i = sum_{j>i} alpha_j T_j (g . c_j) + T_end (g . B + dL/dT_end),
// the last for a loss that looks at T_end, too.

// The derivatives of one splat in one pixel.
template <class T>
struct ShareGradient {
  T weight;   // dC/dc = alpha T
  T falloff;  // dL/dpower, power = -d^T conic d / 2; over opacity, it is dL/dopacity
  T behind;   // `behind` for the splat in front of this one
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
