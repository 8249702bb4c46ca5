// Renaming and turning over of axes as products of quaternions, in double, rounded once.
#include "algorithm/vq/canonical_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sgs {
namespace {

using Quat = std::array<double, 4>;  // (w, x, y, z)

Quat product(const Quat& a, const Quat& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// The rotation that takes x to axis `first` and y to axis `second`.
Quat renaming(int first, int second) {
  constexpr double kHalfRoot = 0.70710678118654752;
  switch (3 * first + second) {
    case 3 * 0 + 1:
      return {1, 0, 0, 0};
    case 3 * 0 + 2:
      return {kHalfRoot, kHalfRoot, 0, 0};
    case 3 * 1 + 0:
      return {0, kHalfRoot, kHalfRoot, 0};
    case 3 * 1 + 2:
      return {0.5, 0.5, 0.5, 0.5};
    case 3 * 2 + 0:
      return {0.5, -0.5, -0.5, -0.5};
    default:
      return {kHalfRoot, 0, -kHalfRoot, 0};  // 2, 1
  }
}

}  // namespace

CanonicalShape canonical_shape(const glm::vec3& scale, const std::array<float, 4>& quat) {
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return scale[a] > scale[b]; });
  const Quat q = product({quat[0], quat[1], quat[2], quat[3]}, renaming(order[0], order[1]));

  // q times 1, i, j, k: half turns about the ellipsoid's own axes.
  const Quat turned[4] = {{q[0], q[1], q[2], q[3]},
                          {-q[1], q[0], q[3], -q[2]},
                          {-q[2], -q[3], q[0], q[1]},
                          {-q[3], q[2], -q[1], q[0]}};
  const Quat& best = *std::max_element(
      std::begin(turned), std::end(turned),
      [](const Quat& a, const Quat& b) { return std::abs(a[0]) < std::abs(b[0]); });
  const double sign = best[0] < 0 ? -1 : 1;
  CanonicalShape out{};
  for (int k = 0; k < 3; ++k) out.scale[k] = scale[order[static_cast<std::size_t>(k)]];
  for (std::size_t k = 0; k < 4; ++k) out.quat[k] = static_cast<float>(sign * best[k]);
  return out;
}

}  // namespace sgs
