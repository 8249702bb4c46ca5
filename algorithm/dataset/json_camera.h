// What a camera's object in JSON says in the same keys, whatever the form: lens, size, matrix.
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <vector>

#include "algorithm/dataset/lens.h"
#include "algorithm/files/input_json.h"

namespace sgs {

// All throw InputError that names the place.

// From camera_model or is_fisheye, with distortion_params or k1 to k6, p1, p2. Refuses keys of
// cameras that are neither pinhole nor fisheye, and of pictures that are no projection from one
// place.
Lens lens_of(const JsonPlace& camera);

// A whole number of px from 1.
int size_px(const JsonPlace& place);

// 3 rows or as many as `columns`, of so many numbers; what is not there is the identity's.
glm::dmat4 matrix_of(const JsonPlace& place, std::size_t columns);

// Counts the keys of `object` that are neither in `known` nor read, or refused, by lens_of().
void count_unread(const JsonPlace& object, const std::vector<std::string>& known,
                  std::map<std::string, int>& counts);

}  // namespace sgs
