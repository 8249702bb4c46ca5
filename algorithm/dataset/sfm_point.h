// A point of a data set out of the numbers that state it.
#pragma once

#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "algorithm/dataset/dataset.h"

namespace sgs {

// Throws InputError that begins with `where`: coordinates that are not finite or too large.
SfmPoint sfm_point(const glm::dvec3& position, const glm::u8vec3& colour, const std::string& where);

}  // namespace sgs
