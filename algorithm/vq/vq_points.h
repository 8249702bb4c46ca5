// What codebooks are made from and searched with: the parameters of Gaussians as points.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/memory/codebook.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/vq/canonical_shape.h"
#include "algorithm/vq/point_set.h"

namespace sgs {

// [N]
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
