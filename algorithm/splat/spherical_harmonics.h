// View-dependent colour from spherical-harmonics coefficients, degrees 0 to 3.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/splat/scalar.h"

namespace sgs {

// Factors of the basis functions of degrees 0 to 3, in their order.
constexpr double kShFactor[16] = {
    0.28209479177387814, -0.4886025119029199, 0.4886025119029199,  -0.4886025119029199,
    1.0925484305920792,  -1.0925484305920792, 0.31539156525252005, -1.0925484305920792,
    0.5462742152960396,  -0.5900435899266435, 2.890611442640554,   -0.4570457994644658,
    0.3731763325901154,  -0.4570457994644658, 1.445305721320277,   -0.5900435899266435};

// Values of the real SH basis in direction (x, y, z), unit length; basis[0 .. (degree+1)^2).
template <class T>
void sh_basis(int degree, T x, T y, T z, T (&basis)[16]) {
  const auto c = [](int k) { return constant<T>(kShFactor[k]); };
  basis[0] = c(0);
  if (degree < 1) return;
  basis[1] = T(c(1) * y);
  basis[2] = T(c(2) * z);
  basis[3] = T(c(3) * x);
  if (degree < 2) return;
  const T xx = T(x * x), yy = T(y * y), zz = T(z * z), xy = T(x * y), yz = T(y * z), xz = T(x * z);
  const T two = T(2.0F), three = T(3.0F), four = T(4.0F);
  basis[4] = T(c(4) * xy);
  basis[5] = T(c(5) * yz);
  basis[6] = T(c(6) * T(two * zz - xx - yy));
  basis[7] = T(c(7) * xz);
  basis[8] = T(c(8) * T(xx - yy));
  if (degree < 3) return;
  basis[9] = T(c(9) * y * T(three * xx - yy));
  basis[10] = T(c(10) * xy * z);
  basis[11] = T(c(11) * y * T(four * zz - xx - yy));
  basis[12] = T(c(12) * z * T(two * zz - three * xx - three * yy));
  basis[13] = T(c(13) * x * T(four * zz - xx - yy));
  basis[14] = T(c(14) * z * T(xx - yy));
  basis[15] = T(c(15) * x * T(xx - three * yy));
}

// Colour of a Gaussian whose centre lies at `offset` from the eye (world axes): SH of
// offset/|offset|, plus 0.5, clamped below at 0. coeffs: [(degree+1)^2] rgb.
template <class T>
glm::vec<3, T> sh_colour(int degree, const glm::vec<3, T>* coeffs, const glm::vec<3, T>& offset) {
  T x = offset.x, y = offset.y, z = offset.z;
  if (degree > 0) {
    const T inverse = T(T(1.0F) / sqrt_of(T(x * x + y * y + z * z)));
    x = T(x * inverse);
    y = T(y * inverse);
    z = T(z * inverse);
  }
  T basis[16];
  sh_basis(degree, x, y, z, basis);
  glm::vec<3, T> colour;
  for (int channel = 0; channel < 3; ++channel) {
    T sum = T(0.5F);
    for (int k = 0; k < (degree + 1) * (degree + 1); ++k)
      sum = T(sum + basis[k] * coeffs[k][channel]);
    colour[channel] = max_of(T(0.0F), sum);
  }
  return colour;
}

}  // namespace sgs
