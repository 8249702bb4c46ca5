// Colour from spherical harmonics (splat/spherical_harmonics.h), differentiated.
#pragma once

#include "algorithm/splat/spherical_harmonics.h"

namespace sgs {

// dL/d(x, y, z) of sum_k weights[k] basis_k(x, y, z), each coordinate by itself.
template <class T>
glm::vec<3, T> sh_direction_gradient(int degree, T x, T y, T z, const T (&weights)[16]) {
  const auto c = [&](int k) { return T(constant<T>(kShFactor[k]) * weights[k]); };
  glm::vec<3, T> out{c(3), c(1), c(2)};
  if (degree < 2) return out;
  const T two = T(2.0F), three = T(3.0F), four = T(4.0F), six = T(6.0F), eight = T(8.0F);
  const T c4 = c(4), c5 = c(5), c6 = T(two * c(6)), c7 = c(7), c8 = T(two * c(8));
  out.x = T(out.x + c4 * y - c6 * x + c7 * z + c8 * x);
  out.y = T(out.y + c4 * x + c5 * z - c6 * y - c8 * y);
  out.z = T(out.z + c5 * y + two * c6 * z + c7 * x);
  if (degree < 3) return out;
  const T xx = T(x * x), yy = T(y * y), zz = T(z * z), xy = T(x * y), yz = T(y * z), xz = T(x * z);
  const T c9 = c(9), c10 = c(10), c11 = c(11), c12 = c(12), c13 = c(13), c14 = c(14), c15 = c(15);
  out.x = T(out.x + c9 * six * xy + c10 * yz - c11 * two * xy - c12 * six * xz +
            c13 * T(four * zz - three * xx - yy) + c14 * two * xz + c15 * three * T(xx - yy));
  out.y = T(out.y + c9 * three * T(xx - yy) + c10 * xz + c11 * T(four * zz - xx - three * yy) -
            c12 * six * yz - c13 * two * xy - c14 * two * yz - c15 * six * xy);
  out.z = T(out.z + c10 * xy + c11 * eight * yz + c12 * T(six * zz - three * xx - three * yy) +
            c13 * eight * xz + c14 * T(xx - yy));
  return out;
}

// dL/doffset of colour = sh_colour(degree, coeffs, offset), and into by_coeffs [(degree+1)^2] rgb
// dL/dcoeffs, given dL/dcolour. Nothing comes through a channel that is clamped at 0.
template <class T>
glm::vec<3, T> colour_gradient(int degree, const glm::vec<3, T>* coeffs,
                               const glm::vec<3, T>& offset, const glm::vec<3, T>& colour,
                               const glm::vec<3, T>& by_colour, glm::vec<3, T>* by_coeffs) {
  const int count = (degree + 1) * (degree + 1);
  const T inverse =
      T(T(1.0F) / sqrt_of(T(offset.x * offset.x + offset.y * offset.y + offset.z * offset.z)));
  const T x = T(offset.x * inverse), y = T(offset.y * inverse), z = T(offset.z * inverse);
  T basis[16], weights[16];
  sh_basis(degree, x, y, z, basis);
  glm::vec<3, T> passed;
  for (int channel = 0; channel < 3; ++channel) {
    passed[channel] = T(0.0F) < colour[channel] ? by_colour[channel] : T(0.0F);
  }
  for (int k = 0; k < count; ++k) {
    by_coeffs[k] = {T(passed.x * basis[k]), T(passed.y * basis[k]), T(passed.z * basis[k])};
    weights[k] = T(passed.x * coeffs[k].x + passed.y * coeffs[k].y + passed.z * coeffs[k].z);
  }
  if (degree == 0) return glm::vec<3, T>{T(0.0F)};
  const auto by_direction = sh_direction_gradient(degree, x, y, z, weights);
  const T along = T(by_direction.x * x + by_direction.y * y + by_direction.z * z);
  return {T(T(by_direction.x - along * x) * inverse), T(T(by_direction.y - along * y) * inverse),
          T(T(by_direction.z - along * z) * inverse)};
}

}  // namespace sgs
