#include "algorithm/dataset/colmap_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

// f_x, f_y or f for both; c_x, c_y; then a letter each: 1 to 6 for k1 to k6, p and q for p1 and p2,
// - for one that is not read.
struct ColmapLens {
  const char* model;
  int focals;
  const char* rest;
  LensKind kind;
};

// By their number in the file. EQUIRECTANGULAR has two numbers in all.
constexpr std::array<ColmapLens, 18> kLenses = {
    {{"SIMPLE_PINHOLE", 1, "", LensKind::kPerspective},
     {"PINHOLE", 2, "", LensKind::kPerspective},
     {"SIMPLE_RADIAL", 1, "1", LensKind::kPerspective},
     {"RADIAL", 1, "12", LensKind::kPerspective},
     {"OPENCV", 2, "12pq", LensKind::kPerspective},
     {"OPENCV_FISHEYE", 2, "1234", LensKind::kFisheye},
     {"FULL_OPENCV", 2, "12pq3456", LensKind::kPerspective},
     {"FOV", 2, "1", LensKind::kFov},
     {"SIMPLE_RADIAL_FISHEYE", 1, "1", LensKind::kFisheye},
     {"RADIAL_FISHEYE", 1, "12", LensKind::kFisheye},
     {"THIN_PRISM_FISHEYE", 2, "--------", LensKind::kOther},
     {"RAD_TAN_THIN_PRISM_FISHEYE", 2, "------------", LensKind::kOther},
     {"SIMPLE_DIVISION", 1, "1", LensKind::kDivision},
     {"DIVISION", 2, "1", LensKind::kDivision},
     {"SIMPLE_FISHEYE", 1, "", LensKind::kFisheye},
     {"FISHEYE", 2, "", LensKind::kFisheye},
     {"EUCM", 2, "--", LensKind::kOther},
     {"EQUIRECTANGULAR", 0, "", LensKind::kOther}}};

int count_of(const ColmapLens& lens) {
  return lens.focals + 2 + static_cast<int>(std::string_view(lens.rest).size());
}

const ColmapLens* lens_of(std::string_view model) {
  const auto found = std::find_if(kLenses.begin(), kLenses.end(),
                                  [&](const ColmapLens& lens) { return lens.model == model; });
  return found == kLenses.end() ? nullptr : &*found;
}

}  // namespace

std::string colmap_model_name(std::int32_t number, const std::string& where) {
  if (number >= 0 && number < static_cast<std::int32_t>(kLenses.size())) {
    return kLenses[static_cast<std::size_t>(number)].model;
  }
  throw InputError(fmt::format("{}: got the camera model number {}, expected 0 to {}", where,
                               number, kLenses.size() - 1));
}

std::optional<int> colmap_parameter_count(std::string_view model) {
  const ColmapLens* lens = lens_of(model);
  if (lens == nullptr) return {};
  return count_of(*lens);
}

Intrinsics colmap_intrinsics(const ColmapCamera& camera) {
  if (camera.width < 1 || camera.height < 1 || camera.width > INT32_MAX ||
      camera.height > INT32_MAX) {
    throw InputError(fmt::format("{}: size: got {}x{}, expected px from 1", camera.where,
                                 camera.width, camera.height));
  }
  for (const double parameter : camera.parameters) {
    if (!std::isfinite(parameter)) {
      throw InputError(
          fmt::format("{}: parameter: got {}, expected finite numbers", camera.where, parameter));
    }
  }
  Intrinsics out;
  out.width = static_cast<int>(camera.width);
  out.height = static_cast<int>(camera.height);
  out.lens.model = camera.model;
  const ColmapLens* lens = lens_of(camera.model);
  out.lens.kind = lens == nullptr ? LensKind::kOther : lens->kind;
  if (out.lens.kind == LensKind::kOther) return out;
  auto next = camera.parameters.begin();
  out.focal_x = *next;
  if (lens->focals == 2) ++next;
  out.focal_y = *next++;
  out.centre_x = *next++;
  out.centre_y = *next++;
  for (const char* letter = lens->rest; *letter != '\0'; ++letter) {
    double& coefficient = *letter == 'p'   ? out.lens.p1
                          : *letter == 'q' ? out.lens.p2
                                           : out.lens.k[static_cast<std::size_t>(*letter - '1')];
    coefficient = *next++;
  }
  return out;
}

}  // namespace sgs
