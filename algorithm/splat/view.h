// A camera as the projection needs it, in the scalar type of the datapath.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

template <class T>
struct View {
  glm::vec<3, T> position;           // camera centre, world
  glm::vec<3, T> cam_from_world[3];  // rows of R^T: the camera's x, y, z axes in the world frame
  T focal_x, focal_y;                // px
  T limit_x, limit_y;                // clamp of v_x/v_z and v_y/v_z in the Jacobian
  T centre_x, centre_y;              // px: (size - 1) / 2, since pixel (0,0) has its centre at 0
  int width, height;                 // px
};

template <class T>
View<T> make_view(const Camera& camera) {
  View<T> view{};
  for (int k = 0; k < 3; ++k) {
    view.position[k] = constant<T>(camera.position[k]);
    for (int row = 0; row < 3; ++row) {
      view.cam_from_world[row][k] = constant<T>(camera.world_from_camera[row][k]);
    }
  }
  view.focal_x = constant<T>(camera.focal_x);
  view.focal_y = constant<T>(camera.focal_y);
  view.limit_x = constant<T>(kFrustumGuard * camera.width / (2 * camera.focal_x));
  view.limit_y = constant<T>(kFrustumGuard * camera.height / (2 * camera.focal_y));
  view.centre_x = constant<T>(0.5 * (camera.width - 1));
  view.centre_y = constant<T>(0.5 * (camera.height - 1));
  view.width = camera.width;
  view.height = camera.height;
  return view;
}

// v = R^T (p - c), camera frame.
template <class T>
glm::vec<3, T> to_camera(const View<T>& view, const glm::vec<3, T>& p) {
  const T x = T(p.x - view.position.x), y = T(p.y - view.position.y), z = T(p.z - view.position.z);
  glm::vec<3, T> v;
  for (int row = 0; row < 3; ++row) {
    const auto& axis = view.cam_from_world[row];
    v[row] = T(axis.x * x + axis.y * y + axis.z * z);
  }
  return v;
}

}  // namespace sgs
