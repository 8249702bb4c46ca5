// Checks of cameras: those that are refused throw.
#include "algorithm/splat/view.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

void check_drawable(const Camera& camera) {
  const auto [low, high] = std::minmax(camera.width, camera.height);
  if (low < 1 || high > kMaxFramePx) {
    throw InputError(fmt::format("camera {}: size {}x{} px, expected 1 to {} a side", camera.id,
                                 camera.width, camera.height, kMaxFramePx));
  }
  if (!(camera.focal_x <= kMaxFocalPx && camera.focal_y <= kMaxFocalPx)) {
    throw InputError(fmt::format("camera {}: focal lengths {} and {} px, expected at most {}",
                                 camera.id, camera.focal_x, camera.focal_y, kMaxFocalPx));
  }
  const glm::dvec3& at = camera.position;
  const auto is_far = [](double x) { return !(std::abs(x) <= kMaxCoordinate); };
  if (is_far(at.x) || is_far(at.y) || is_far(at.z)) {
    throw InputError(fmt::format("camera {}: position {} {} {}, expected magnitudes of at most {}",
                                 camera.id, at.x, at.y, at.z, kMaxCoordinate));
  }
}

}  // namespace sgs
