// A camera as the projection needs it, in the scalar type of the datapath.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

template <class T>
struct View {
  glm::vec<3, T> position;      // camera centre, world, rounded to T
  glm::vec<3, T> position_low;  // remainder of that rounding: far from the origin it is visible
  glm::vec<3, T> cam_from_world[3];  // rows of R^T: the camera's x, y, z axes in the world frame
  T focal_x, focal_y;                // px
  T stretch;                         // at least the largest singular value of cam_from_world
  T limit_x, limit_y;                // clamp of v_x/v_z and v_y/v_z in the Jacobian
  // Principal point, px: (size - 1) / 2 where it is in the middle, as pixel (0,0) has its centre at
  // 0.
  T centre_x, centre_y;
  int width, height;  // px
  // eyes: 2 where it is the left one of two eyes with parallel axes, `eyes_apart`; tests of boxes
  // and of frames then hold for both, all else is of the one. aside: it is the right one. That
  // computes from the same `position` with the same axes, and is moved by `eye` in the camera
  // frame, by to_eye in the world: so v_y and v_z are those of the left eye to the bit.
  bool aside;
  T eye;
  glm::vec<3, T> to_eye;
  int eyes;
  T eyes_apart;
};

// Largest singular value of R, from above: sqrt of the largest row sum of |R^T R|. 1 for a
// rotation; cameras come from files, where it is one only within the reader's tolerance.
inline double largest_stretch(const glm::dmat3& r) {
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    double row = 0;
    for (int j = 0; j < 3; ++j) row += std::abs(glm::dot(r[i], r[j]));
    squared = std::max(squared, row);
  }
  return std::sqrt(squared);
}

// Throws InputError when the frame has no pixels or more than kMaxFramePx a side, or when focal
// lengths or position are beyond gaussian_cloud.h.
void check_drawable(const Camera& camera);

// Throws InputError as check_drawable does.
template <class T>
View<T> make_view(const Camera& camera) {
  check_drawable(camera);
  View<T> view{};
  for (int k = 0; k < 3; ++k) {
    view.position[k] = constant<T>(camera.position[k]);
    view.position_low[k] = constant<T>(camera.position[k] - static_cast<double>(view.position[k]));
    for (int row = 0; row < 3; ++row) {
      view.cam_from_world[row][k] = constant<T>(camera.world_from_camera[row][k]);
    }
  }
  view.focal_x = constant<T>(camera.focal_x);
  view.focal_y = constant<T>(camera.focal_y);
  view.stretch = constant<T>(largest_stretch(camera.world_from_camera));
  // Beside the middle: the guard is as far from the border that is farther away.
  const glm::dvec2 offset = camera.principal_offset;
  view.limit_x = constant<T>(kFrustumGuard * camera.width / (2 * camera.focal_x) +
                             std::abs(offset.x) / camera.focal_x);
  view.limit_y = constant<T>(kFrustumGuard * camera.height / (2 * camera.focal_y) +
                             std::abs(offset.y) / camera.focal_y);
  view.centre_x = constant<T>(0.5 * (camera.width - 1) + offset.x);
  view.centre_y = constant<T>(0.5 * (camera.height - 1) + offset.y);
  view.width = camera.width;
  view.height = camera.height;
  view.eyes = camera.eyes_apart != 0 ? 2 : 1;
  view.eyes_apart = constant<T>(camera.eyes_apart);
  return view;
}

// What the right eye sees whose left one this is.
template <class T>
View<T> right_eye(const View<T>& left) {
  View<T> view = left;
  view.aside = true;
  view.eye = left.eyes_apart;
  for (int k = 0; k < 3; ++k) view.to_eye[k] = T(left.eyes_apart * left.cam_from_world[0][k]);
  view.eyes = 1;
  return view;
}

// p - c, world frame. The first difference is exact where p and c are close to each other compared
// with the origin, so that a scene at coordinates of 10^6 is seen as sharply as one at 0.
template <class T>
glm::vec<3, T> from_eye(const View<T>& view, const glm::vec<3, T>& p) {
  return {T(T(p.x - view.position.x) - view.position_low.x),
          T(T(p.y - view.position.y) - view.position_low.y),
          T(T(p.z - view.position.z) - view.position_low.z)};
}

// The direction in which the view's own eye sees p, world frame, not normalised.
template <class T>
glm::vec<3, T> sight(const View<T>& view, const glm::vec<3, T>& p) {
  const auto d = from_eye(view, p);
  if (!view.aside) return d;
  return {T(d.x - view.to_eye.x), T(d.y - view.to_eye.y), T(d.z - view.to_eye.z)};
}

// v = R^T (p - c), camera frame; of an eye beside c, x from there.
template <class T>
glm::vec<3, T> to_camera(const View<T>& view, const glm::vec<3, T>& p) {
  const auto d = from_eye(view, p);
  glm::vec<3, T> v;
  for (int row = 0; row < 3; ++row) {
    const auto& axis = view.cam_from_world[row];
    v[row] = T(axis.x * d.x + axis.y * d.y + axis.z * d.z);
  }
  if (view.aside) v.x = T(v.x - view.eye);
  return v;
}

}  // namespace sgs
