// Projection of one Gaussian to the screen: sections 2.1 to 2.7 of the rendering semantics of the
// original rasteriser (affine approximation of the perspective at the centre, EWA splatting).
#pragma once

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/view.h"

namespace sgs {

// A Gaussian on the screen. Frame: pixels, x right, y down, pixel (0,0) has its centre at (0,0).
template <class T>
struct Projected {
  T x, y;                       // px, centre
  T depth;                      // v_z, camera frame, world units
  T cov_a, cov_b, cov_c;        // px^2: [a b; b c], low-pass included
  T conic_a, conic_b, conic_c;  // 1/px^2: inverse of the covariance
  T determinant;                // px^4
  T radius;                     // px, whole: ceil(3 sqrt(lambda))
};

// u, w of section 2.4: v_x/v_z and v_y/v_z clamped to the guarded frustum.
template <class T>
struct ClampedRatio {
  T u, w;
};
template <class T>
ClampedRatio<T> clamped_ratio(const View<T>& view, const glm::vec<3, T>& v) {
  return {clamp_of(T(v.x / v.z), T(-view.limit_x), view.limit_x),
          clamp_of(T(v.y / v.z), T(-view.limit_y), view.limit_y)};
}

// Pixel position of a point in the camera frame: ((v_x/(v_z tan_x) + 1) width - 1) / 2 with
// tan_x = width / (2 f_x).
template <class T>
glm::vec<2, T> to_pixel(const View<T>& view, const glm::vec<3, T>& v) {
  return {T(view.focal_x * T(v.x / v.z) + view.centre_x),
          T(view.focal_y * T(v.y / v.z) + view.centre_y)};
}

// Rotation matrix of a unit quaternion (w, x, y, z); rows.
template <class T>
void rotation_rows(const std::array<T, 4>& q, T (&rows)[3][3]) {
  const T w = q[0], x = q[1], y = q[2], z = q[3];
  const T one = T(1.0F), two = T(2.0F);
  rows[0][0] = T(one - two * T(y * y + z * z));
  rows[0][1] = T(two * T(x * y - w * z));
  rows[0][2] = T(two * T(x * z + w * y));
  rows[1][0] = T(two * T(x * y + w * z));
  rows[1][1] = T(one - two * T(x * x + z * z));
  rows[1][2] = T(two * T(y * z - w * x));
  rows[2][0] = T(two * T(x * z - w * y));
  rows[2][1] = T(two * T(y * z + w * x));
  rows[2][2] = T(one - two * T(x * x + y * y));
}

// R^T R(q): the axes of a Gaussian (columns) in the camera frame, unit length.
template <class T>
void axes_in_camera(const View<T>& view, const std::array<T, 4>& quat, T (&axes)[3][3]) {
  T rotation[3][3];
  rotation_rows(quat, rotation);
  for (int row = 0; row < 3; ++row) {
    const auto& axis = view.cam_from_world[row];
    for (int col = 0; col < 3; ++col) {
      axes[row][col] =
          T(axis.x * rotation[0][col] + axis.y * rotation[1][col] + axis.z * rotation[2][col]);
    }
  }
}

// J R^T M, and the parts of J.
template <class T>
struct AxesOnScreen {
  T u1[3], u2[3];  // px, its rows: x and y of each scaled axis
  T jx, jy;        // px a world unit: f / v_z
  ClampedRatio<T> ratio;
};

// m: R^T M, the scaled axes (columns) in the camera frame.
template <class T>
AxesOnScreen<T> axes_on_screen(const View<T>& view, const glm::vec<3, T>& v, const T (&m)[3][3]) {
  AxesOnScreen<T> out;
  out.ratio = clamped_ratio(view, v);
  out.jx = T(view.focal_x / v.z);
  out.jy = T(view.focal_y / v.z);
  for (int k = 0; k < 3; ++k) {
    out.u1[k] = T(out.jx * T(m[0][k] - out.ratio.u * m[2][k]));
    out.u2[k] = T(out.jy * T(m[1][k] - out.ratio.w * m[2][k]));
  }
  return out;
}

// Projects g, whose centre is v in the camera frame with v_z > 0.2.
// Sigma = M M^T with M = R(q) diag(scale), Cov2D = (J R^T M)(J R^T M)^T + 0.3 I. With u1, u2 the
// rows of J R^T M, det = 0.09 + 0.3 (|u1|^2 + |u2|^2) + |u1 x u2|^2: the sum of the minors, which
// keeps its digits where a c - b^2 cancels (needles; condition numbers beyond 10^6).
template <class T>
Projected<T> project(const View<T>& view, const Gaussian<T>& g, const glm::vec<3, T>& v) {
  Projected<T> out;
  const auto pixel = to_pixel(view, v);
  out.x = pixel.x;
  out.y = pixel.y;
  out.depth = v.z;

  T m[3][3];
  axes_in_camera(view, g.quat, m);
  for (auto& row : m) {
    for (int col = 0; col < 3; ++col) row[col] = T(row[col] * g.scale[col]);
  }
  const AxesOnScreen<T> axes = axes_on_screen(view, v, m);
  const T(&u1)[3] = axes.u1, (&u2)[3] = axes.u2;
  const T uu = T(u1[0] * u1[0] + u1[1] * u1[1] + u1[2] * u1[2]);
  const T ww = T(u2[0] * u2[0] + u2[1] * u2[1] + u2[2] * u2[2]);
  const T uw = T(u1[0] * u2[0] + u1[1] * u2[1] + u1[2] * u2[2]);
  const T cx = T(u1[1] * u2[2] - u1[2] * u2[1]), cy = T(u1[2] * u2[0] - u1[0] * u2[2]),
          cz = T(u1[0] * u2[1] - u1[1] * u2[0]);
  const T low_pass = constant<T>(kLowPass);
  out.cov_a = T(uu + low_pass);
  out.cov_b = uw;
  out.cov_c = T(ww + low_pass);
  out.determinant =
      T(constant<T>(kLowPass * kLowPass) + low_pass * T(uu + ww) + T(cx * cx + cy * cy + cz * cz));
  out.conic_a = T(out.cov_c / out.determinant);
  out.conic_b = T(-out.cov_b / out.determinant);
  out.conic_c = T(out.cov_a / out.determinant);

  // mid^2 - det = ((a - c)/2)^2 + b^2, without the cancellation.
  const T half = T(0.5F);
  const T mid = T(half * T(out.cov_a + out.cov_c)), lean = T(half * T(out.cov_a - out.cov_c));
  const T lambda =
      T(mid + sqrt_of(max_of(constant<T>(kMinDiscriminant), T(lean * lean + uw * uw))));
  using std::ceil;
  out.radius = T(ceil(T(constant<T>(kRadiusSigmas) * sqrt_of(lambda))));
  return out;
}

}  // namespace sgs
