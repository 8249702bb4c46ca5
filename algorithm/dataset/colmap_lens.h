// The camera models of COLMAP (colmap.github.io/cameras.html; src/colmap/sensor/models.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "algorithm/dataset/colmap_model.h"

namespace sgs {

// Its name by its number in binary files. Throws InputError that begins with `where`: no such
// number.
std::string colmap_model_name(std::int32_t number, const std::string& where);

// Numbers that a camera of this model has; nothing of a model that is not COLMAP's.
std::optional<int> colmap_parameter_count(std::string_view model);

// Throws InputError that begins with camera.where: a size that is no number of px from 1, a
// parameter that is not finite. A model that is not read is one of LensKind::kOther.
Intrinsics colmap_intrinsics(const ColmapCamera& camera);

}  // namespace sgs
