// Canonical shapes, then the points of each codebook.
#include "algorithm/vq/vq_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sgs {

// Renaming and turning over of axes as products of quaternions, in double, rounded once.

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

namespace {

// Added to ratios of scales before the logarithm: below a fiftieth of the largest axis, thinner is
// not seen, and entries spent on it would be lost to others.
constexpr double kThinnest = 0.02;

// A length by the largest one, in [0, 1] also where both are 0 or have overflowed to infinity.
double ratio_of(float scale, float largest) {
  return scale == largest ? 1 : static_cast<double>(scale) / largest;
}

float log_ratio(double ratio) { return static_cast<float>(std::log(ratio + kThinnest)); }
float ratio_of_log(float value) {
  return static_cast<float>(std::clamp(std::exp(static_cast<double>(value)) - kThinnest, 0.0, 1.0));
}

// Points [N, dims] of which `fill(i, point)` writes each.
template <class Fill>
PointSet make_points(const std::vector<float>& weights, std::uint32_t dims, Fill&& fill) {
  PointSet points;
  points.dims = static_cast<int>(dims);
  points.weights = weights;
  points.values.resize(weights.size() * dims);
  tbb::parallel_for(std::size_t{0}, weights.size(),
                    [&](std::size_t i) { fill(i, points.values.data() + i * dims); });
  return points;
}

}  // namespace

std::vector<CanonicalShape> canonical_shapes(const ActivatedCloud& cloud) {
  std::vector<CanonicalShape> shapes(cloud.size());
  tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
    shapes[i] = canonical_shape(cloud.gaussians[i].scale, cloud.gaussians[i].quat);
  });
  return shapes;
}

PointSet scale_points(const std::vector<CanonicalShape>& shapes,
                      const std::vector<float>& weights) {
  return make_points(weights, kScaleDims, [&](std::size_t i, float* point) {
    const glm::vec3& scale = shapes[i].scale;
    point[0] = log_ratio(ratio_of(scale[1], scale[0]));
    point[1] = log_ratio(ratio_of(scale[2], scale[0]));
  });
}

void scale_entry_of(const float* point, float* entry) {
  entry[0] = 1;
  entry[1] = ratio_of_log(point[0]);
  entry[2] = ratio_of_log(point[1]);
}

void scale_point_of(const float* entry, float* point) {
  point[0] = log_ratio(entry[1]);
  point[1] = log_ratio(entry[2]);
}

PointSet colour_points(const ActivatedCloud& cloud, const std::vector<float>& weights,
                       Codebook codebook) {
  const std::uint32_t words = codebook_words(codebook, cloud.sh_degree);
  const std::uint32_t first_word = codebook == Codebook::kDc ? 0 : 3;
  return make_points(weights, words, [&](std::size_t i, float* point) {
    for (std::uint32_t w = 0; w < words; ++w) {
      const std::uint32_t word = first_word + w;
      point[w] = cloud.sh(i)[word / 3][static_cast<int>(word % 3)];
    }
  });
}

std::uint8_t opacity_code(float opacity) {
  constexpr float kLevels = 255;
  if (opacity < 1 / kLevels) return 0;
  return static_cast<std::uint8_t>(std::clamp(std::round(opacity * kLevels), 1.0F, kLevels));
}

}  // namespace sgs
