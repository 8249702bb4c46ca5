// Projection (splat/projection.h), differentiated.
#pragma once

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/projection.h"
#include "algorithm/tune/gradient_rule.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// Of L with respect to the entries of a rotation matrix, by those of a unit quaternion: the
// polynomials of rotation_rows() as they stand, each component by itself.
template <class T>
std::array<T, 4> rotation_gradient(const std::array<T, 4>& quat, const T (&r)[3][3]) {
  const T w = quat[0], x = quat[1], y = quat[2], z = quat[3];
  const T two = T(2.0F);
  return {T(two * T(x * (r[2][1] - r[1][2]) + y * (r[0][2] - r[2][0]) + z * (r[1][0] - r[0][1]))),
          T(two * T(y * (r[0][1] + r[1][0]) + z * (r[0][2] + r[2][0]) + w * (r[2][1] - r[1][2]) -
                    two * x * (r[1][1] + r[2][2]))),
          T(two * T(x * (r[0][1] + r[1][0]) + z * (r[1][2] + r[2][1]) + w * (r[0][2] - r[2][0]) -
                    two * y * (r[0][0] + r[2][2]))),
          T(two * T(x * (r[0][2] + r[2][0]) + y * (r[1][2] + r[2][1]) + w * (r[1][0] - r[0][1]) -
                    two * z * (r[0][0] + r[1][1])))};
}

// dL/dv of what depends on v / v_z and on f / v_z: the centre of the splat and J.
// by_u, by_w: dL/d of the clamped ratios. by_size: sum of dL/d of f / v_z, times f / v_z.
template <class T>
glm::vec<3, T> perspective_gradient(const View<T>& view, const glm::vec<3, T>& v,
                                    const AxesOnScreen<T>& axes, const SplatGradient<T>& splat,
                                    T by_u, T by_w, T by_size, GradientRule rule) {
  const T zero = T(0.0F);
  const T ratio_x = T(v.x / v.z), ratio_y = T(v.y / v.z);
  T by_ratio_x = T(splat.x * view.focal_x), by_ratio_y = T(splat.y * view.focal_y);
  // The original: J's u / v_z^2 with u fixed, so twice what f / v_z says by itself.
  T held = zero;
  const auto add = [&](T ratio, T limit, T clamped, T by_clamped, T& by_ratio) {
    if (!(ratio < T(-limit)) && !(limit < ratio)) {
      by_ratio = T(by_ratio + by_clamped);
    } else if (rule == GradientRule::kOriginal) {
      held = T(held + by_clamped * clamped);
    }
  };
  add(ratio_x, view.limit_x, axes.ratio.u, by_u, by_ratio_x);
  add(ratio_y, view.limit_y, axes.ratio.w, by_w, by_ratio_y);
  return {T(by_ratio_x / v.z), T(by_ratio_y / v.z),
          T(-T(by_ratio_x * ratio_x + by_ratio_y * ratio_y + by_size + held) / v.z)};
}

// dL/d of mean, scale and (unit) quaternion of g, whose centre is v in the camera frame; the
// quaternion's with each component by itself, as if it need not stay of unit length. Opacity is
// handed on.
template <class T>
Gaussian<T> projection_gradient(const View<T>& view, const Gaussian<T>& g, const glm::vec<3, T>& v,
                                const SplatGradient<T>& splat, GradientRule rule) {
  T directions[3][3], m[3][3];
  axes_in_camera(view, g.quat, directions);
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) m[row][k] = T(directions[row][k] * g.scale[k]);
  }
  const AxesOnScreen<T> axes = axes_on_screen(view, v, m);

  // cov = [u1.u1, u1.u2; u1.u2, u2.u2] + 0.3 I; u1 = jx (m_0 - u m_2), u2 = jy (m_1 - w m_2).
  const T two = T(2.0F);
  T by_m[3][3], by_u = T(0.0F), by_w = T(0.0F), by_size = T(0.0F);
  for (int k = 0; k < 3; ++k) {
    const T by_u1 = T(two * splat.cov_a * axes.u1[k] + splat.cov_b * axes.u2[k]);
    const T by_u2 = T(two * splat.cov_c * axes.u2[k] + splat.cov_b * axes.u1[k]);
    const T by_x = T(by_u1 * axes.jx), by_y = T(by_u2 * axes.jy);
    by_m[0][k] = by_x;
    by_m[1][k] = by_y;
    by_m[2][k] = T(-T(by_x * axes.ratio.u + by_y * axes.ratio.w));
    by_u = T(by_u - by_x * m[2][k]);
    by_w = T(by_w - by_y * m[2][k]);
    by_size = T(by_size + by_u1 * axes.u1[k] + by_u2 * axes.u2[k]);
  }

  Gaussian<T> out{};
  out.opacity = splat.opacity;
  const auto by_v = perspective_gradient(view, v, axes, splat, by_u, by_w, by_size, rule);
  T by_rotation[3][3];  // world
  for (int k = 0; k < 3; ++k) {
    out.scale[k] = T(by_m[0][k] * directions[0][k] + by_m[1][k] * directions[1][k] +
                     by_m[2][k] * directions[2][k]);
    out.mean[k] = T(by_v.x * view.cam_from_world[0][k] + by_v.y * view.cam_from_world[1][k] +
                    by_v.z * view.cam_from_world[2][k]);
    for (int row = 0; row < 3; ++row) {
      by_rotation[row][k] = T(g.scale[k] * T(by_m[0][k] * view.cam_from_world[0][row] +
                                             by_m[1][k] * view.cam_from_world[1][row] +
                                             by_m[2][k] * view.cam_from_world[2][row]));
    }
  }
  out.quat = rotation_gradient(g.quat, by_rotation);
  return out;
}

}  // namespace sgs
