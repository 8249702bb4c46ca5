// The derivatives of a loss with respect to a splat on the screen.
#pragma once

#include <glm/vec3.hpp>

namespace sgs {

// Of the covariance rather than of the conic, its inverse: with e = conic d, each pixel's part is a
// product of components of e, where by way of the conic it would be one of components of d, huge
// along a needle, whose differences would have to cancel.
template <class T>
struct SplatGradient {
  T x{}, y{};                   // centre, 1/px
  T cov_a{}, cov_b{}, cov_c{};  // 1/px^2; cov_b is one number that stands twice in [a b; b c]
  T opacity{};
  glm::vec<3, T> rgb{};

  SplatGradient& operator+=(const SplatGradient& other) {
    x += other.x;
    y += other.y;
    cov_a += other.cov_a;
    cov_b += other.cov_b;
    cov_c += other.cov_c;
    opacity += other.opacity;
    rgb += other.rgb;
    return *this;
  }
};

}  // namespace sgs
