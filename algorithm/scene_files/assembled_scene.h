// Scenes put together of parts: Gaussians moved as a whole, and parts joined.
#pragma once

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// A rotation, one scale and a translation.
class Placement {
 public:
  // None where the matrix does anything else: scales that differ by axis, shear, mirroring.
  static std::optional<Placement> of(const glm::dmat4& matrix);
  // From axes as SceneReadOptions names them to right, down, forward. None where they name no three
  // axes, or mirror.
  static std::optional<Placement> from_axes(std::string_view axes);

  // Moves the Gaussian in the slots of ply_vertex.h, SH of `degree` with it: coefficients are those
  // that give the colour of old directions in the new ones.
  void apply(int degree, float* slots) const;

 private:
  Placement(const glm::dmat3& rotation, double scale, const glm::dvec3& translation);

  glm::dmat3 rotation_;
  glm::dquat quat_;
  double scale_;
  glm::dvec3 translation_;
  std::array<std::vector<double>, 4> sh_;  // of each degree l: [2 l + 1, 2 l + 1]
};

// All Gaussians of `contents`, moved. Throws InputError as decoded_scene does.
SceneContents placed(const std::string& origin, SceneContents contents, const Placement& placement,
                     const SceneReadOptions& options);

// Adds `more` behind what `all` holds. origin: of `more`, for messages. Throws InputError where
// they differ in degree.
void append_scene(const std::string& origin, SceneContents&& more, SceneContents& all);

}  // namespace sgs
