// Directions of pixel rays.
#include "algorithm/voxel/ray.h"

namespace sgs {

Ray pixel_ray(const View<float>& view, int x, int y) {
  const float right = (static_cast<float>(x) - view.centre_x) / view.focal_x;
  const float down = (static_cast<float>(y) - view.centre_y) / view.focal_y;
  Ray ray{};
  ray.origin = view.position;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = right * view.cam_from_world[0][axis] + down * view.cam_from_world[1][axis] +
                    view.cam_from_world[2][axis];
    ray.direction[axis] = d;
    ray.step[axis] = d > 0 ? 1 : (d < 0 ? -1 : 0);
    ray.inverse[axis] = d == 0 ? 0.0F : 1.0F / d;
  }
  return ray;
}

}  // namespace sgs
