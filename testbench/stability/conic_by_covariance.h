// A form of the completed square that was tried in float: by the covariance [a b; b c] on the
// screen, B/A = -b/c and C - B^2/A = 1/c, so that nothing cancels.
#pragma once

#include "algorithm/splat/constants.h"
#include "algorithm/splat/projection.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {

template <class T>
SquareConic<T> conic_by_covariance(const Projected<T>& p) {
  const T factor = constant<T>(-0.5 * kLog2E);
  return {T(p.conic_a * factor), T(-p.cov_b / p.cov_c), T(factor / p.cov_c)};
}

}  // namespace sgs
