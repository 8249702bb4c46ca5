// The checks of poses and points, and the changes of axes.
#include "algorithm/dataset/stated_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

constexpr double kOrthonormalTolerance = 1e-3;  // as cameras.json has it

void check_finite(const double* values, int count, const std::string& where) {
  for (int i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(fmt::format("{}: pose: got {}, expected finite numbers", where, values[i]));
    }
  }
}

}  // namespace

Projection projection_of(const Intrinsics& stated, int image_width, int image_height) {
  Projection out;
  out.width = stated.width > 0 ? stated.width : image_width;
  out.height = stated.height > 0 ? stated.height : image_height;
  const auto focal_of = [](const std::optional<double>& focal, const std::optional<double>& angle,
                           int size) -> std::optional<double> {
    if (focal || !angle) return focal;
    return 0.5 * size / std::tan(0.5 * *angle);
  };
  const auto x = focal_of(stated.focal_x, stated.angle_x, out.width);
  const auto y = focal_of(stated.focal_y, stated.angle_y, out.height);
  out.focal = {x ? *x : y.value_or(0), y ? *y : x.value_or(0)};
  out.centre = {stated.centre_x.value_or(0.5 * out.width),
                stated.centre_y.value_or(0.5 * out.height)};
  return out;
}

Pose opencv_pose(const glm::dmat4& world_from_camera, const std::string& where) {
  check_finite(&world_from_camera[0][0], 16, where);
  for (int column = 0; column < 4; ++column) {
    const double expected = column == 3 ? 1 : 0;
    if (world_from_camera[column][3] != expected) {
      throw InputError(
          fmt::format("{}: pose: got {} as number {} of the last row, expected 0 0 0 1", where,
                      world_from_camera[column][3], column));
    }
  }
  const glm::dmat3 axes(world_from_camera);
  const glm::dmat3 gram = glm::transpose(axes) * axes;
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j ? 1 : 0)));
  }
  if (!(worst <= kOrthonormalTolerance)) {
    throw InputError(fmt::format(
        "{}: pose: got axes that are off by {:.3g}, expected them orthonormal within 1e-3", where,
        worst));
  }
  if (glm::determinant(axes) < 0) {
    throw InputError(fmt::format("{}: pose: got a mirrored frame, expected determinant +1", where));
  }
  return {glm::dvec3(world_from_camera[3]), axes};
}

Pose opengl_pose(const glm::dmat4& world_from_camera, const std::string& where) {
  Pose pose = opencv_pose(world_from_camera, where);
  pose.world_from_camera[1] = -pose.world_from_camera[1];
  pose.world_from_camera[2] = -pose.world_from_camera[2];
  return pose;
}

Pose colmap_pose(const glm::dquat& camera_from_world, const glm::dvec3& translation,
                 const std::string& where) {
  const double numbers[] = {camera_from_world.w, camera_from_world.x, camera_from_world.y,
                            camera_from_world.z, translation.x,       translation.y,
                            translation.z};
  check_finite(numbers, 7, where);
  const double length = glm::length(camera_from_world);
  if (!(length > 0 && std::isfinite(length))) {
    throw InputError(
        fmt::format("{}: pose: got a quaternion of length {}, expected about 1", where, length));
  }
  // The inverse of a rotation is its transpose.
  const glm::dmat3 rotation = glm::mat3_cast(camera_from_world / length);
  const glm::dmat3 world_from_camera = glm::transpose(rotation);
  return {-(world_from_camera * translation), world_from_camera};
}

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
