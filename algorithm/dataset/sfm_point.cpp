#include "algorithm/dataset/sfm_point.h"

#include <fmt/format.h>

#include <cmath>

#include "algorithm/input_error.h"
#include "algorithm/scene/gaussian_limits.h"

namespace sgs {

SfmPoint sfm_point(const glm::dvec3& position, const glm::u8vec3& colour,
                   const std::string& where) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) <= kMaxCoordinate)) {
      throw InputError(fmt::format("{}: position: got {}, expected finite numbers of at most {}",
                                   where, position[axis], kMaxCoordinate));
    }
  }
  return {glm::vec3(position), glm::vec3(colour) / 255.0f};
}

}  // namespace sgs
