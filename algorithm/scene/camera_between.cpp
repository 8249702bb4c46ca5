#include "algorithm/scene/camera_between.h"

#include <glm/gtc/quaternion.hpp>

namespace sgs {

Camera camera_between(const Camera& a, const Camera& b, double t) {
  Camera camera = a;
  // Ends are the poses as given: a quaternion and back rounds.
  if (t == 0) return camera;
  if (t == 1) {
    camera.position = b.position;
    camera.world_from_camera = b.world_from_camera;
    return camera;
  }
  camera.position = (1 - t) * a.position + t * b.position;
  camera.world_from_camera = glm::mat3_cast(
      glm::slerp(glm::quat_cast(a.world_from_camera), glm::quat_cast(b.world_from_camera), t));
  return camera;
}

}  // namespace sgs
