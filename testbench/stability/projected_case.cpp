// How they lie.
#include "testbench/stability/projected_case.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace sgs {
namespace {

constexpr double kThin = 1e-10;  // share of the longest axis

// axes: columns in the camera frame, orthonormal but for their sign. The mean is unused.
ProjectedCase placed(const Camera& camera, const glm::dvec3& v, glm::dmat3 axes,
                     const glm::dvec3& scale) {
  ProjectedCase out;
  out.camera = camera;
  out.v = glm::vec3(v);
  if (glm::determinant(axes) < 0) axes[2] = -axes[2];
  const glm::dquat q = glm::normalize(glm::quat_cast(camera.world_from_camera * axes));
  out.gaussian.mean = glm::vec3(camera.world_from_camera * v);
  out.gaussian.scale = glm::vec3(scale);
  out.gaussian.quat = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                       static_cast<float>(q.z)};
  out.gaussian.opacity = 0.9F;
  return out;
}

// One axis across the screen, one along the line of sight.
glm::dmat3 across(const glm::dvec3& v, Random& random) {
  const double angle = random.uniform(0, 2 * M_PI);
  const glm::dvec3 sight = glm::normalize(v), leaning(std::cos(angle), std::sin(angle), 0);
  const glm::dvec3 along = glm::normalize(leaning - glm::dot(leaning, sight) * sight);
  return {along, sight, glm::cross(along, sight)};
}

glm::dvec3 in_frame(double z, Random& random) {
  return {random.uniform(-0.6, 0.6) * z, random.uniform(-0.35, 0.35) * z, z};
}

}  // namespace

Camera turned_camera(Random& random) {
  Camera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.focal_x = camera.focal_y = 1000;
  const glm::dvec3 z = random.direction(), x = glm::normalize(glm::cross(z, random.direction()));
  camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  return camera;
}

ExactGaussian ProjectedCase::exact_gaussian() const {
  ExactGaussian out;
  out.mean = exact(gaussian.mean);
  out.scale = exact(gaussian.scale);
  for (std::size_t k = 0; k < 4; ++k) out.quat[k] = gaussian.quat[k];
  return out;
}

ExactSplat ProjectedCase::exact_splat() const {
  return exact_project(exact_view(camera), exact_gaussian(), exact(v));
}

ProjectedCase long_splat(double condition, Random& random) {
  const Camera camera = turned_camera(random);
  const double z = log_uniform(random, 0.25, 1);
  const glm::dvec3 v = in_frame(z, random);
  const double scale = std::sqrt(kLowPass * condition) * z / camera.focal_x;
  const bool disc = random.uniform() < 1.0 / 3;
  return placed(camera, v, across(v, random), {scale, disc ? scale : kThin * scale, kThin * scale});
}

ProjectedCase nearly_round(double difference, Random& random) {
  const Camera camera = turned_camera(random);
  const double z = log_uniform(random, 0.25, 100), scale = 1000 * z / camera.focal_x;
  const glm::dvec3 v(0, 0, z);
  return placed(camera, v, across(v, random), {scale, scale, scale * std::sqrt(1 - difference)});
}

ProjectedCase wide_disc(double sigma_px, Random& random) {
  const Camera camera = turned_camera(random);
  const double z = log_uniform(random, 0.25, 1);
  const glm::dvec3 v = in_frame(z, random);
  const glm::dmat3 axes = across(v, random);
  const double tilt = random.uniform(0.3, 1.2);
  const glm::dvec3 second = std::cos(tilt) * axes[2] + std::sin(tilt) * axes[1];
  const double scale = sigma_px * z / camera.focal_x;
  return placed(camera, v, {axes[0], second, glm::cross(axes[0], second)},
                {scale, scale, kThin * scale});
}

ProjectedCase near_plane(double distance, Random& random) {
  const Camera camera = turned_camera(random);
  const double z = kNearPlane + distance;
  const glm::dvec3 v = in_frame(z, random);
  return placed(camera, v, across(v, random),
                {0.1 * z, 0.1 * z * random.uniform(0.1, 1), 0.1 * z * random.uniform(0.1, 1)});
}

}  // namespace sgs
