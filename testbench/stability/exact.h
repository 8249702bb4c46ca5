// Numbers of 100 decimal digits: what a formula gives where nothing is rounded. A sum that cancels
// all but one part in 10^40 still has 60 digits.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

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

}  // namespace sgs
