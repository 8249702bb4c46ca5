// One form for each ellipsoid: scales and quaternion name the same one in 48 ways.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace sgs {

// scale: any order; quat: (w, x, y, z), unit length. Out: scales falling, and of the quaternions
// that give the same ellipsoid the one with w >= |x|, |y|, |z|. Axes of an ellipsoid can be renamed
// (R diag(s) becomes R P diag(P^T s), P a rotation by quarter turns) and turned over in pairs
// without changing R diag(s)^2 R^T: a codebook need not tell these apart.
struct CanonicalShape {
  glm::vec3 scale;
  std::array<float, 4> quat;
};
CanonicalShape canonical_shape(const glm::vec3& scale, const std::array<float, 4>& quat);

}  // namespace sgs
