// Pixel rays in units of cell planes, for the grid traversal.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "algorithm/splat/view.h"

namespace sgs {

// A ray from the camera's centre. Times are multiples of `direction`; the plane between cells i - 1
// and i of an axis is crossed at (i voxel_size - origin) / direction. That is computed from i
// alone, so the order of crossings does not depend on the path by which the planes were reached,
// and since it is monotonic in i every traversal is a monotonic walk over the lattice: no two rays
// from one centre can ever disagree about the order of two cells.
template <class T>
struct RayOf {
  glm::vec<3, T> origin, direction, inverse;
  glm::ivec3 step;  // -1, 0, 1

  T plane_time(int axis, IndexOf<T> plane, T voxel_size) const {
    if (step[axis] == 0) return T(std::numeric_limits<float>::infinity());
    return (number_of<T>(plane) * voxel_size - origin[axis]) * inverse[axis];
  }
};
using Ray = RayOf<float>;

// Ray through the centre of pixel (x, y), whole numbers; world frame.
template <class T>
RayOf<T> pixel_ray_of(const View<T>& view, T x, T y) {
  const T right = (x - view.centre_x) / view.focal_x;
  const T down = (y - view.centre_y) / view.focal_y;
  RayOf<T> ray{};
  ray.origin = view.position;
  for (int axis = 0; axis < 3; ++axis) {
    const T d = right * view.cam_from_world[0][axis] + down * view.cam_from_world[1][axis] +
                view.cam_from_world[2][axis];
    const float sign = value_of(d);
    ray.direction[axis] = d;
    ray.step[axis] = sign > 0 ? 1 : (sign < 0 ? -1 : 0);
    ray.inverse[axis] = sign == 0 ? T(0.0F) : T(1.0F) / d;
  }
  return ray;
}
Ray pixel_ray(const View<float>& view, int x, int y);

// Whether the crossing of one plane comes before that of another; equal times go by axis.
template <class T>
bool crosses_before(T time_a, int axis_a, T time_b, int axis_b) {
  return time_a < time_b || (time_a <= time_b && axis_a < axis_b);
}

}  // namespace sgs
