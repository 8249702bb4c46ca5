// Checks that text and binary models share (colmap_model.h).
#include "algorithm/dataset/colmap_model.h"

#include <fmt/format.h>

#include <cmath>

#include "algorithm/input_error.h"

namespace sgs {

int colmap_parameter_count(std::string_view model, const std::string& where) {
  if (model == "SIMPLE_PINHOLE") return 3;  // f, c_x, c_y
  if (model == "PINHOLE") return 4;         // f_x, f_y, c_x, c_y
  throw InputError(fmt::format(
      "{}: got the camera model {}, expected PINHOLE or SIMPLE_PINHOLE (COLMAP's image_undistorter "
      "makes them)",
      where, model));
}

Intrinsics colmap_intrinsics(std::uint64_t width, std::uint64_t height,
                             const std::vector<double>& parameters, const std::string& where) {
  if (width < 1 || height < 1 || width > INT32_MAX || height > INT32_MAX) {
    throw InputError(fmt::format("{}: size: got {}x{}, expected px from 1", where, width, height));
  }
  for (const double parameter : parameters) {
    if (!std::isfinite(parameter)) {
      throw InputError(
          fmt::format("{}: parameter: got {}, expected finite numbers", where, parameter));
    }
  }
  const bool one_focal = parameters.size() == 3;
  const std::size_t centre = one_focal ? 1 : 2;
  return {static_cast<int>(width), static_cast<int>(height), parameters[0],
          parameters[one_focal ? 0 : 1], glm::dvec2(parameters[centre], parameters[centre + 1])};
}

void add_colmap_camera(ColmapModel& model, std::uint32_t id, const Intrinsics& camera,
                       const std::string& where) {
  if (!model.cameras.emplace(id, camera).second) {
    throw InputError(fmt::format("{}: camera id {} a second time, expected each once", where, id));
  }
}

}  // namespace sgs
