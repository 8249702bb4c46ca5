// The real spherical harmonics of degrees 0 to 3, signs as in the rendering semantics.
#include "testbench/stability/exact_colour.h"

#include <boost/math/constants/constants.hpp>

namespace sgs {

ExactVector exact_colour(int degree, const std::vector<ExactVector>& coeffs,
                         const ExactVector& offset) {
  static const Exact pi = boost::math::constants::pi<Exact>();
  const auto root = [](int numerator, int denominator) {
    return Exact(sqrt(Exact(numerator) / (denominator * pi)));
  };
  // sqrt(n / (d pi)) of each kind of polynomial.
  static const Exact f0 = root(1, 4), f1 = root(3, 4), f2 = root(15, 4), f2z = root(5, 16),
                     f2d = root(15, 16), f3 = root(35, 32), f3p = root(105, 4), f3y = root(21, 32),
                     f3z = root(7, 16), f3d = root(105, 16);
  const Exact size = degree > 0 ? length(offset) : Exact(1);
  const Exact x = offset[0] / size, y = offset[1] / size, z = offset[2] / size;
  const Exact basis[16] = {f0,
                           -f1 * y,
                           f1 * z,
                           -f1 * x,
                           f2 * x * y,
                           -f2 * y * z,
                           f2z * (2 * z * z - x * x - y * y),
                           -f2 * x * z,
                           f2d * (x * x - y * y),
                           -f3 * y * (3 * x * x - y * y),
                           f3p * x * y * z,
                           -f3y * y * (4 * z * z - x * x - y * y),
                           f3z * z * (2 * z * z - 3 * x * x - 3 * y * y),
                           -f3y * x * (4 * z * z - x * x - y * y),
                           f3d * z * (x * x - y * y),
                           -f3 * x * (x * x - 3 * y * y)};
  ExactVector colour{Exact(1) / 2, Exact(1) / 2, Exact(1) / 2};
  for (std::size_t k = 0; k < coeffs.size(); ++k) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      colour[channel] += basis[k] * coeffs[k][channel];
    }
  }
  return colour;
}

}  // namespace sgs
