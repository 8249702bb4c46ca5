// Gaussians moved as a whole: a rotation, one scale and a translation.
#pragma once

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace sgs {

class Placement {
 public:
  // None where the matrix does anything else: scales that differ by axis, shear, mirroring.
  static std::optional<Placement> of(const glm::dmat4& matrix);

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

}  // namespace sgs
