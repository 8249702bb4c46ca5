// A camera whose numbers can be followed by hand: at the origin, looking along z.
#pragma once

#include "algorithm/scene/camera.h"

namespace sgs::test {

inline Camera camera_at_origin() {
  Camera camera;
  camera.width = 100;
  camera.height = 50;
  camera.focal_x = 100;
  camera.focal_y = 80;
  return camera;
}

}  // namespace sgs::test
