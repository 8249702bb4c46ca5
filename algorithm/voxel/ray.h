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

  T plane_time(int axis, int plane, T voxel_size) const {
    if (step[axis] == 0) return T(std::numeric_limits<float>::infinity());
    return (T(static_cast<float>(plane)) * voxel_size - origin[axis]) * inverse[axis];
  }
};
using Ray = RayOf<float>;

// Ray through the centre of pixel (x, y); world frame.
Ray pixel_ray(const View<float>& view, int x, int y);

// Whether the crossing of one plane comes before that of another; equal times go by axis.
template <class T>
bool crosses_before(T time_a, int axis_a, T time_b, int axis_b) {
  return time_a < time_b || (time_a <= time_b && axis_a < axis_b);
}

}  // namespace sgs
