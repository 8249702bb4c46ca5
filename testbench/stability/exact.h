// Numbers of 100 decimal digits: what a formula gives where nothing is rounded. A sum that cancels
// all but one part in 10^40 still has 60 digits.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                            boost::multiprecision::et_off>;
using ExactVector = std::array<Exact, 3>;
using ExactMatrix = std::array<ExactVector, 3>;  // rows

template <class T>
ExactVector exact(const glm::vec<3, T>& v) {
  return {Exact(v.x), Exact(v.y), Exact(v.z)};
}

inline Exact dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Exact length(const ExactVector& a) { return sqrt(dot(a, a)); }

inline ExactMatrix transposed(const ExactMatrix& m) {
  ExactMatrix out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = m[j][i];
  }
  return out;
}

inline ExactMatrix product(const ExactMatrix& a, const ExactMatrix& b) {
  const ExactMatrix columns = transposed(b);
  ExactMatrix out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = dot(a[i], columns[j]);
  }
  return out;
}

// Colour by spherical harmonics with all its digits; the factors from their closed forms.

// rgb of coefficients [(degree+1)^2] seen along `offset` (world, any length), before the clamp at
// 0.
ExactVector exact_colour(int degree, const std::vector<ExactVector>& coeffs,
                         const ExactVector& offset);

// Section 2 of the rendering semantics as it is written: matrices multiplied out, the determinant
// as a c - b^2, the inverse by it. No form that algorithm/splat chose for its rounding.
struct ExactView {
  ExactVector position;
  ExactMatrix cam_from_world;
  Exact focal_x, focal_y, limit_x, limit_y, centre_x, centre_y;
};
ExactView exact_view(const Camera& camera);

struct ExactGaussian {
  ExactVector mean, scale;
  std::array<Exact, 4> quat;  // (w, x, y, z), as if of unit length
};

struct ExactSplat {
  Exact x, y, depth;
  Exact cov_a, cov_b, cov_c, determinant;
  Exact conic_a, conic_b, conic_c;
  Exact lambda;  // the radius is 3 sqrt(lambda)
};

// v = R^T (p - c).
ExactVector exact_to_camera(const ExactView& view, const ExactVector& mean);

// v: the centre in the camera frame.
ExactSplat exact_project(const ExactView& view, const ExactGaussian& g, const ExactVector& v);

// The covariance [a b; b c] of two rows u1, u2 = J R^T M, low-pass included, and what follows.
void complete(ExactSplat& splat);

}  // namespace sgs
