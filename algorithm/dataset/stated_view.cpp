// The checks of poses, cameras and points, and the changes of axes.
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

constexpr double kOrthonormalTolerance = 1e-3;
constexpr std::string_view kOpencvAxes = "from camera to world, columns right, down and forward";
constexpr std::string_view kOpenglAxes = "from camera to world, columns right, up and backward";
constexpr std::string_view kColmapAxes =
    "from world to camera, whose axes are right, down and forward";

void check_finite(const double* values, int count, const std::string& where) {
  for (int i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(fmt::format("{}: got {}, expected finite numbers", where, values[i]));
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
      throw InputError(fmt::format("{}: got {} as number {} of the last row, expected 0 0 0 1",
                                   where, world_from_camera[column][3], column));
    }
  }
  const glm::dmat3 axes(world_from_camera);
  const glm::dmat3 gram = glm::transpose(axes) * axes;
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j ? 1 : 0)));
  }
  if (!(worst <= kOrthonormalTolerance)) {
    throw InputError(
        fmt::format("{}: got axes that are off by {:.3g}, expected columns orthonormal within 1e-3",
                    where, worst));
  }
  if (glm::determinant(axes) < 0) {
    throw InputError(fmt::format("{}: got a mirrored frame, expected determinant +1", where));
  }
  return {glm::dvec3(world_from_camera[3]), axes, kOpencvAxes};
}

Pose opengl_pose(const glm::dmat4& world_from_camera, const std::string& where) {
  Pose pose = opencv_pose(world_from_camera, where);
  pose.world_from_camera[1] = -pose.world_from_camera[1];
  pose.world_from_camera[2] = -pose.world_from_camera[2];
  pose.axes = kOpenglAxes;
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
        fmt::format("{}: got a quaternion of length {}, expected about 1", where, length));
  }
  // The inverse of a rotation is its transpose.
  const glm::dmat3 rotation = glm::mat3_cast(camera_from_world / length);
  const glm::dmat3 world_from_camera = glm::transpose(rotation);
  return {-(world_from_camera * translation), world_from_camera, kColmapAxes};
}

void check_camera(const StatedView& view, const Projection& projection) {
  check_lens(view.intrinsics.lens, view.where);
  for (const double focal_px : {projection.focal.x, projection.focal.y}) {
    if (!(focal_px > 0 && focal_px <= kMaxFocalPx)) {
      throw InputError(fmt::format("{}: focal length: got {}, expected px above 0, at most {}",
                                   view.where, focal_px, kMaxFocalPx));
    }
  }
  const glm::dvec3& at = view.pose.position;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(at[axis]) <= kMaxCoordinate) continue;
    throw InputError(
        fmt::format("{}: position: got ({}, {}, {}), expected finite numbers of at most {}",
                    view.where, at.x, at.y, at.z, kMaxCoordinate));
  }
}

Camera camera_of(const StatedView& view, const Projection& projection) {
  const glm::dvec2 size(projection.width, projection.height);
  for (int axis = 0; axis < 2; ++axis) {
    const double at = projection.centre[axis];
    if (at >= 0 && at <= size[axis]) continue;
    throw InputError(
        fmt::format("{}: principal point: got {} at {} px of {}, expected it in the picture",
                    view.where, axis == 0 ? "x" : "y", at, size[axis]));
  }
  Camera camera;
  camera.width = projection.width;
  camera.height = projection.height;
  camera.focal_x = projection.focal.x;
  camera.focal_y = projection.focal.y;
  camera.position = view.pose.position;
  camera.world_from_camera = view.pose.world_from_camera;
  camera.principal_offset = projection.centre - 0.5 * size;
  camera.axes = view.pose.axes;
  return camera;
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
