// Three cameras side by side, looking along z.
#pragma once

#include <vector>

#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {

inline std::vector<Camera> cameras_in_a_row() {
  std::vector<Camera> out;
  for (const double x : {-0.3, 0.0, 0.3}) {
    out.push_back(forward_camera(96, 64, 80));
    out.back().position.x = x;
  }
  return out;
}

}  // namespace sgs::test
