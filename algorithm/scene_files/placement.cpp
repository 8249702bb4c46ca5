// The matrices of SH, found from colours in many directions.
#include "algorithm/scene_files/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/splat/spherical_harmonics.h"

namespace sgs {
namespace {

// Turns by right angles move every coefficient as a whole: no rounding of ours is to change that.
double without_rounding(double value) {
  constexpr double kRounding = 1e-12;
  const double whole = std::round(value);
  return std::abs(value - whole) < kRounding ? whole : value;
}

// Values of the 2 degree + 1 basis functions of one degree.
std::vector<double> band_of(int degree, const glm::dvec3& direction) {
  double basis[16];
  sh_basis(degree, direction.x, direction.y, direction.z, basis);
  return {basis + degree * degree, basis + (degree + 1) * (degree + 1)};
}

// X of A X = B, all [n, n], by elimination with the largest pivot of each column.
std::vector<double> solved(std::vector<double> a, std::vector<double> b, std::size_t n) {
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row) {
      if (std::abs(a[row * n + column]) > std::abs(a[pivot * n + column])) pivot = row;
    }
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(a[column * n + k], a[pivot * n + k]);
      std::swap(b[column * n + k], b[pivot * n + k]);
    }
    for (std::size_t row = 0; row < n; ++row) {
      if (row == column) continue;
      const double factor = a[row * n + column] / a[column * n + column];
      for (std::size_t k = 0; k < n; ++k) {
        a[row * n + k] -= factor * a[column * n + k];
        b[row * n + k] -= factor * b[column * n + k];
      }
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < n; ++k) b[row * n + k] /= a[row * n + row];
  }
  return b;
}

// The matrix that takes coefficients of a degree to those of the rotated function: those that come
// nearest to its values in directions all over the sphere, which is exactly.
std::vector<double> sh_matrix(int degree, const glm::dmat3& rotation) {
  constexpr int kDirections = 64;
  const std::size_t n = 2 * static_cast<std::size_t>(degree) + 1;
  std::vector<double> now(n * n), before(n * n);
  for (int i = 0; i < kDirections; ++i) {
    // Along a spiral.
    const double z = 1 - 2 * (i + 0.5) / kDirections, angle = 2.4 * i;
    const double radius = std::sqrt(1 - z * z);
    const glm::dvec3 direction(radius * std::cos(angle), radius * std::sin(angle), z);
    const std::vector<double> band = band_of(degree, direction);
    const std::vector<double> old = band_of(degree, glm::transpose(rotation) * direction);
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t k = 0; k < n; ++k) {
        now[row * n + k] += band[row] * band[k];
        before[row * n + k] += band[row] * old[k];
      }
    }
  }
  std::vector<double> matrix = solved(std::move(now), std::move(before), n);
  std::transform(matrix.begin(), matrix.end(), matrix.begin(), without_rounding);
  return matrix;
}

}  // namespace

Placement::Placement(const glm::dmat3& rotation, double scale, const glm::dvec3& translation)
    : rotation_(rotation),
      quat_(glm::quat_cast(rotation)),
      scale_(scale),
      translation_(translation) {
  if (quat_.w <= 0) quat_ = -quat_;
  for (int degree = 1; degree <= 3; ++degree) sh_[degree] = sh_matrix(degree, rotation);
}

std::optional<Placement> Placement::of(const glm::dmat4& matrix) {
  constexpr double kMostOff = 1e-4;  // matrices come from floats
  glm::dmat3 linear(matrix);
  const double scale = glm::length(linear[0]);
  if (!(scale > 0) || !std::isfinite(scale)) return {};
  linear /= scale;
  const glm::dmat3 square = glm::transpose(linear) * linear;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(square[i][k] - (i == k ? 1 : 0)) <= kMostOff)) return {};
    }
  }
  if (glm::determinant(linear) < 0) return {};
  const glm::dvec3 translation(matrix[3]);
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(translation[i])) return {};
  }
  return Placement(linear, scale, translation);
}

void Placement::apply(int degree, float* slots) const {
  const float* mean = slots + kMeanSlot;
  const glm::dvec3 moved =
      rotation_ * (scale_ * glm::dvec3(mean[0], mean[1], mean[2])) + translation_;
  const float* q = slots + kRotationSlot;
  const glm::dquat turned = quat_ * glm::dquat(q[0], q[1], q[2], q[3]);
  for (int i = 0; i < 3; ++i) {
    slots[kMeanSlot + i] = static_cast<float>(moved[i]);
    slots[kScaleSlot + i] =
        static_cast<float>(static_cast<double>(slots[kScaleSlot + i]) + std::log(scale_));
  }
  const double parts[] = {turned.w, turned.x, turned.y, turned.z};
  std::transform(std::begin(parts), std::end(parts), slots + kRotationSlot,
                 [](double part) { return static_cast<float>(part); });
  for (int channel = 0; channel < 3; ++channel) {
    for (int l = 1; l <= degree; ++l) {
      const int n = 2 * l + 1;
      float* band = slots + rest_slot(degree, channel, l * l - 1);
      std::array<float, 7> before{};
      std::copy_n(band, n, before.begin());
      for (int row = 0; row < n; ++row) {
        double sum = 0;
        for (int k = 0; k < n; ++k) sum += sh_[l][row * n + k] * static_cast<double>(before[k]);
        band[row] = static_cast<float>(sum);
      }
    }
  }
}

}  // namespace sgs
