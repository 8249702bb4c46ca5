// Directions of pixel rays.
#include "algorithm/voxel/ray.h"

namespace sgs {

Ray pixel_ray(const View<float>& view, int x, int y) {
  return pixel_ray_of(view, static_cast<float>(x), static_cast<float>(y));
}

}  // namespace sgs
