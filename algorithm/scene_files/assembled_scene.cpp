// The matrices of SH, and clouds column by column.
#include "algorithm/scene_files/assembled_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "algorithm/files/input_error.h"
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

// The matrix that takes coefficients of a degree to those of the rotated function: integrals of the
// products of two basis functions, one of them rotated. Lebedev's rule of 26 points is exact for
// them, since they are polynomials of degree 6 at most and the rule is exact up to 7.
std::vector<double> sh_matrix(int degree, const glm::dmat3& rotation) {
  // Of points on axes, between two and between three of them, in shares of the sphere.
  constexpr double kWeights[] = {1 / 21.0, 4 / 105.0, 9 / 280.0};
  constexpr double kSphere = 12.566370614359172;  // 4 pi
  const std::size_t n = 2 * static_cast<std::size_t>(degree) + 1;
  std::vector<double> matrix(n * n);
  for (int point = 0; point < 27; ++point) {
    const glm::dvec3 corner(point % 3 - 1, point / 3 % 3 - 1, point / 9 - 1);
    const auto axes = static_cast<int>(glm::dot(corner, corner));
    if (axes == 0) continue;
    const glm::dvec3 direction = glm::normalize(corner);
    const std::vector<double> band = band_of(degree, direction);
    const std::vector<double> old = band_of(degree, glm::transpose(rotation) * direction);
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t k = 0; k < n; ++k) {
        matrix[row * n + k] += kSphere * kWeights[axes - 1] * band[row] * old[k];
      }
    }
  }
  std::transform(matrix.begin(), matrix.end(), matrix.begin(), without_rounding);
  return matrix;
}

// What an INRIA .ply would hold for the Gaussian `index` of a cloud.
void fill_slots(const GaussianCloud& cloud, std::uint64_t index, float* slots) {
  const int coeffs = sh_coeff_count(cloud.sh_degree);
  const glm::vec3* sh = &cloud.sh_coeffs[index * static_cast<std::uint64_t>(coeffs)];
  for (int i = 0; i < 3; ++i) {
    slots[kMeanSlot + i] = cloud.means[index][i];
    slots[kDcSlot + i] = sh[0][i];
    slots[kScaleSlot + i] = cloud.log_scales[index][i];
    for (int k = 1; k < coeffs; ++k) slots[rest_slot(cloud.sh_degree, i, k - 1)] = sh[k][i];
  }
  std::copy_n(cloud.quats[index].begin(), 4, slots + kRotationSlot);
  slots[kOpacitySlot] = cloud.opacity_logits[index];
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

std::optional<Placement> Placement::from_axes(std::string_view axes) {
  constexpr std::string_view kDirections = "rdflub";  // x, y, z, then their opposites
  if (axes.size() != 3) return {};
  glm::dmat4 matrix(0);
  matrix[3][3] = 1;
  for (int i = 0; i < 3; ++i) {
    const std::size_t found = kDirections.find(axes[static_cast<std::size_t>(i)]);
    if (found == std::string_view::npos) return {};
    matrix[i][static_cast<int>(found % 3)] = found < 3 ? 1 : -1;
  }
  return of(matrix);
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

SceneContents placed(const std::string& origin, SceneContents contents, const Placement& placement,
                     const SceneReadOptions& options) {
  const GaussianCloud& cloud = contents.cloud;
  SceneContents moved = decoded_scene(origin, cloud.size(), cloud.sh_degree, options,
                                      [&](std::uint64_t index, float* slots) {
                                        fill_slots(cloud, index, slots);
                                        placement.apply(cloud.sh_degree, slots);
                                      });
  moved.dropped_invalid += contents.dropped_invalid;
  moved.notes = std::move(contents.notes);
  return moved;
}

void append_scene(const std::string& origin, SceneContents&& more, SceneContents& all) {
  GaussianCloud &to = all.cloud, &from = more.cloud;
  if (to.size() == 0) to.sh_degree = from.sh_degree;
  if (from.size() > 0 && to.sh_degree != from.sh_degree) {
    throw InputError(fmt::format("{}: got SH degree {}, expected {} as in the parts before it",
                                 origin, from.sh_degree, to.sh_degree));
  }
  const auto add = [](auto& column, const auto& values) {
    column.insert(column.end(), values.begin(), values.end());
  };
  add(to.means, from.means);
  add(to.log_scales, from.log_scales);
  add(to.quats, from.quats);
  add(to.opacity_logits, from.opacity_logits);
  add(to.sh_coeffs, from.sh_coeffs);
  all.dropped_invalid += more.dropped_invalid;
  for (std::string& note : more.notes) {
    if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) {
      all.notes.push_back(std::move(note));
    }
  }
}

}  // namespace sgs
