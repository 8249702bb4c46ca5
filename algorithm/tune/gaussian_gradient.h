// From a splat's gradient to that of the Gaussian that it is the picture of, and on to the
// parameters in its file: appendix A of Kerbl et al. 2023.
#pragma once

#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/projection.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "algorithm/splat/view.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// Projection (splat/projection.h), differentiated.

// dL/dquaternion from dL/d of the entries of its rotation matrix r: the polynomials of
// rotation_rows() as they stand, each component by itself.
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

// Colour from spherical harmonics (splat/spherical_harmonics.h), differentiated.

// dL/d(x, y, z) of sum_k weights[k] basis_k(x, y, z), each coordinate by itself.
template <class T>
glm::vec<3, T> sh_direction_gradient(int degree, T x, T y, T z, const T (&weights)[16]) {
  const auto c = [&](int k) { return T(constant<T>(kShFactor[k]) * weights[k]); };
  glm::vec<3, T> out{c(3), c(1), c(2)};
  if (degree < 2) return out;
  const T two = T(2.0F), three = T(3.0F), four = T(4.0F), six = T(6.0F), eight = T(8.0F);
  const T c4 = c(4), c5 = c(5), c6 = T(two * c(6)), c7 = c(7), c8 = T(two * c(8));
  out.x = T(out.x + c4 * y - c6 * x + c7 * z + c8 * x);
  out.y = T(out.y + c4 * x + c5 * z - c6 * y - c8 * y);
  out.z = T(out.z + c5 * y + two * c6 * z + c7 * x);
  if (degree < 3) return out;
  const T xx = T(x * x), yy = T(y * y), zz = T(z * z), xy = T(x * y), yz = T(y * z), xz = T(x * z);
  const T c9 = c(9), c10 = c(10), c11 = c(11), c12 = c(12), c13 = c(13), c14 = c(14), c15 = c(15);
  out.x = T(out.x + c9 * six * xy + c10 * yz - c11 * two * xy - c12 * six * xz +
            c13 * T(four * zz - three * xx - yy) + c14 * two * xz + c15 * three * T(xx - yy));
  out.y = T(out.y + c9 * three * T(xx - yy) + c10 * xz + c11 * T(four * zz - xx - three * yy) -
            c12 * six * yz - c13 * two * xy - c14 * two * yz - c15 * six * xy);
  out.z = T(out.z + c10 * xy + c11 * eight * yz + c12 * T(six * zz - three * xx - three * yy) +
            c13 * eight * xz + c14 * T(xx - yy));
  return out;
}

// dL/doffset of colour = sh_colour(degree, coeffs, offset), and into by_coeffs [(degree+1)^2] rgb
// dL/dcoeffs, given dL/dcolour. Nothing comes through a channel that is clamped at 0.
template <class T>
glm::vec<3, T> colour_gradient(int degree, const glm::vec<3, T>* coeffs,
                               const glm::vec<3, T>& offset, const glm::vec<3, T>& colour,
                               const glm::vec<3, T>& by_colour, glm::vec<3, T>* by_coeffs) {
  const int count = (degree + 1) * (degree + 1);
  const T inverse =
      T(T(1.0F) / sqrt_of(T(offset.x * offset.x + offset.y * offset.y + offset.z * offset.z)));
  const T x = T(offset.x * inverse), y = T(offset.y * inverse), z = T(offset.z * inverse);
  T basis[16], weights[16];
  sh_basis(degree, x, y, z, basis);
  glm::vec<3, T> passed;
  for (int channel = 0; channel < 3; ++channel) {
    passed[channel] = T(0.0F) < colour[channel] ? by_colour[channel] : T(0.0F);
  }
  for (int k = 0; k < count; ++k) {
    by_coeffs[k] = {T(passed.x * basis[k]), T(passed.y * basis[k]), T(passed.z * basis[k])};
    weights[k] = T(passed.x * coeffs[k].x + passed.y * coeffs[k].y + passed.z * coeffs[k].z);
  }
  if (degree == 0) return glm::vec<3, T>{T(0.0F)};
  const auto by_direction = sh_direction_gradient(degree, x, y, z, weights);
  const T along = T(by_direction.x * x + by_direction.y * y + by_direction.z * z);
  return {T(T(by_direction.x - along * x) * inverse), T(T(by_direction.y - along * y) * inverse),
          T(T(by_direction.z - along * z) * inverse)};
}

// dL/d of g as the datapath computes with it, and into by_sh [(degree+1)^2] rgb dL/d of its
// coefficients sh. For what make_geometry() and add_colour() draw; colour: by the latter.
template <class T>
Gaussian<T> gaussian_gradient(const View<T>& view, const Gaussian<T>& g, int sh_degree,
                              const glm::vec<3, T>* sh, const glm::vec<3, T>& colour,
                              const SplatGradient<T>& splat, GradientRule rule,
                              glm::vec<3, T>* by_sh) {
  Gaussian<T> out = projection_gradient(view, g, to_camera(view, g.mean), splat, rule);
  const auto by_offset =
      colour_gradient(sh_degree, sh, sight(view, g.mean), colour, splat.rgb, by_sh);
  for (int k = 0; k < 3; ++k) out.mean[k] = T(out.mean[k] + by_offset[k]);
  return out;
}

// Activations (splat/activate.h), differentiated.

// dL/d of a file's parameters from dL/d of those of the datapath; g: activate(raw).
template <class T>
RawGaussian<T> activation_gradient(const RawGaussian<T>& raw, const Gaussian<T>& g,
                                   const Gaussian<T>& by) {
  RawGaussian<T> out{};
  out.mean = by.mean;
  for (int axis = 0; axis < 3; ++axis) out.log_scale[axis] = T(by.scale[axis] * g.scale[axis]);

  // sigmoid' = e / (1 + e)^2 with e = exp(-|logit|): 1 - opacity has no digits left near 1.
  const T zero = T(0.0F), one = T(1.0F);
  const T e = exp_of(raw.opacity_logit < zero ? raw.opacity_logit : T(-raw.opacity_logit));
  const T sum = T(one + e);
  out.opacity_logit = T(by.opacity * T(e / T(sum * sum)));

  // u = q / |q|: dL/dq = (dL/du - u (u . dL/du)) / |q|.
  using Wide = typename ActivationScalar<T>::type;
  Wide squares = Wide(0.0F);
  T along = zero;
  for (std::size_t k = 0; k < 4; ++k) {
    squares = Wide(squares + Wide(raw.quat[k]) * Wide(raw.quat[k]));
    along = T(along + by.quat[k] * g.quat[k]);
  }
  const Wide length = sqrt_of(squares);
  for (std::size_t k = 0; k < 4; ++k) {
    out.quat[k] = T(Wide(T(by.quat[k] - along * g.quat[k])) / length);
  }
  return out;
}

}  // namespace sgs
