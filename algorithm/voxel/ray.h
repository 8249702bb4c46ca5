// Pixel rays through the voxel tree (Amanatides and Woo 1987): directions, distance of cells from
// the eye, and the events on the way.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <limits>

#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

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

// Along one axis of the world, the direction through a pixel that lies so far to the right of the
// view's axis and below it, at distance 1.
template <class T>
T pixel_direction(const View<T>& view, const T& right, const T& down, int axis) {
  return right * view.cam_from_world[0][axis] + down * view.cam_from_world[1][axis] +
         view.cam_from_world[2][axis];
}

// Direction through the centre of pixel (x, y), whole numbers; world frame.
template <class T>
glm::vec<3, T> pixel_direction(const View<T>& view, T x, T y) {
  const T right = (x - view.centre_x) / view.focal_x;
  const T down = (y - view.centre_y) / view.focal_y;
  glm::vec<3, T> direction;
  for (int axis = 0; axis < 3; ++axis) {
    direction[axis] = pixel_direction(view, right, down, axis);
  }
  return direction;
}

// Ray in that direction. Axis by axis: a lane divides while the next direction is summed.
template <class T>
RayOf<T> pixel_ray_of(const View<T>& view, T x, T y) {
  const T right = (x - view.centre_x) / view.focal_x;
  const T down = (y - view.centre_y) / view.focal_y;
  RayOf<T> ray{};
  ray.origin = view.position;
  for (int axis = 0; axis < 3; ++axis) {
    const T d = pixel_direction(view, right, down, axis);
    const float sign = value_of(d);
    ray.direction[axis] = d;
    ray.step[axis] = sign > 0 ? 1 : (sign < 0 ? -1 : 0);
    ray.inverse[axis] = sign == 0 ? T(0.0F) : T(1.0F) / d;
  }
  return ray;
}
inline Ray pixel_ray(const View<float>& view, int x, int y) {
  return pixel_ray_of(view, static_cast<float>(x), static_cast<float>(y));
}

// True if the crossing of one plane comes before that of another; equal times go by axis.
template <class T>
bool crosses_before(T time_a, int axis_a, T time_b, int axis_b) {
  return time_a < time_b || (time_a <= time_b && axis_a < axis_b);
}

// The eye's cell relative to the root's corner. Where the eye lies beyond the root along an axis,
// the cell next to the root stands for it: all that matters is on which side the root lies.
inline glm::ivec3 eye_cell(const glm::vec3& eye, const VoxelFrame& frame) {
  glm::ivec3 cell;
  for (int axis = 0; axis < 3; ++axis) {
    const int at = cell_of(eye[axis], frame.voxel_size) - frame.origin_cell[axis];
    cell[axis] = std::clamp(at, -1, frame.side_cells());
  }
  return cell;
}

// Manhattan distance of a cell of the root from the eye's: less than 2^22. Each crossing from cell
// to cell moves a ray one step away along one axis, so that it rises along every ray of the frame,
// and an order by distance respects all of them.
inline std::uint32_t cells_from_eye(const glm::ivec3& eye, const glm::ivec3& cell) {
  std::uint32_t sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sum += static_cast<std::uint32_t>(std::abs(cell[axis] - eye[axis]));
  }
  return sum;
}

// The events of a ray on its way through the voxel tree. Whoever follows it, at once or beside
// other rays and with time passing, follows the same events.
enum class RayEvent : std::uint8_t {
  kLookUp,  // it wants the node `index`, and goes on when it is given
  kVoxel,   // it meets the voxel `index`
  kStep,    // it has left a block, or taken a sample
  kEnd      // it has left the tree, or never enters it
};

// The numbers that belong to an event: a node's or a voxel's, and of a voxel cells_from_eye(); of a
// step log2 of the cells a side of the block that was left, 0 of a sample.
struct RayEventOf {
  RayEvent what = RayEvent::kEnd;
  std::uint32_t index = 0;
  std::uint32_t cells = 0;
};

}  // namespace sgs
