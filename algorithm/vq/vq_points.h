// The points that codebooks are made from and searched with: the parameters of Gaussians.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/vq/kmeans.h"

namespace sgs {

// One form for each ellipsoid, which scales and quaternion name in 48 ways. scale: any order; quat:
// (w, x, y, z), unit length. Out: scales falling, and of the quaternions that give the same
// ellipsoid the one with w >= |x|, |y|, |z|. Axes of an ellipsoid can be renamed (R diag(s) becomes
// R P diag(P^T s), P a rotation by quarter turns) and turned over in pairs without changing R
// diag(s)^2 R^T: a codebook need not tell these apart.
struct CanonicalShape {
  glm::vec3 scale;
  std::array<float, 4> quat;
};
CanonicalShape canonical_shape(const glm::vec3& scale, const std::array<float, 4>& quat);

// [N] the shape of each Gaussian.
std::vector<CanonicalShape> canonical_shapes(const ActivatedCloud& cloud);

// Scales compare as logarithms of their ratios to the largest: two dimensions. Entries hold ratios,
// the first of them 1.
constexpr int kScaleDims = 2;
PointSet scale_points(const std::vector<CanonicalShape>& shapes, const std::vector<float>& weights);
void scale_entry_of(const float* point, float* entry);
void scale_point_of(const float* entry, float* point);

// codebook: kDc or kSh; points are as long as its entries.
PointSet colour_points(const ActivatedCloud& cloud, const std::vector<float>& weights,
                       Codebook codebook);

// In units of 1/255: below 1/255, which no view can show, 0; others at least 1.
std::uint8_t opacity_code(float opacity);

}  // namespace sgs
