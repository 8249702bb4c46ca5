#include "algorithm/vq/assign.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "algorithm/vq/nearest.h"
#include "algorithm/vq/rotation_codebook.h"
#include "algorithm/vq/vq_points.h"

namespace sgs {
namespace {

std::vector<Nearest> nearest_of(const PointSet& points, const std::vector<float>& centroids,
                                const std::vector<std::uint32_t>& hints) {
  const auto search = make_search(centroids, points.dims);
  std::vector<Nearest> out(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      out[i] = search->find(points[i], hints[i]);
    }
  });
  return out;
}

// Centroids that nothing is nearest to, onto the points that are worst off. Returns whether there
// are any.
bool reuse_idle(const PointSet& points, const std::vector<Nearest>& nearest,
                std::vector<float>& centroids) {
  const auto dims = static_cast<std::size_t>(points.dims);
  std::vector<char> used(centroids.size() / dims, 0);
  for (const Nearest& one : nearest) used[one.index] = 1;
  std::vector<std::size_t> idle;
  for (std::size_t e = 0; e < used.size(); ++e) {
    if (used[e] == 0) idle.push_back(e);
  }
  std::vector<std::uint32_t> worst(points.size());
  std::iota(worst.begin(), worst.end(), 0U);
  const auto error = [&](std::uint32_t i) {
    return points.weights[i] * nearest[i].squared_distance;
  };
  const std::size_t moved = std::min(idle.size(), points.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(moved), worst.end(),
                    [&](std::uint32_t a, std::uint32_t b) {
                      return error(a) != error(b) ? error(a) > error(b) : a < b;
                    });
  for (std::size_t k = 0; k < moved; ++k) {
    std::copy_n(points[worst[k]], dims, &centroids[idle[k] * dims]);
  }
  return moved > 0;
}

void assign_points(const PointSet& points, std::vector<float>& centroids,
                   std::vector<std::uint32_t>& indices) {
  std::vector<Nearest> nearest = nearest_of(points, centroids, indices);
  if (reuse_idle(points, nearest, centroids)) nearest = nearest_of(points, centroids, indices);
  std::transform(nearest.begin(), nearest.end(), indices.begin(),
                 [](const Nearest& one) { return one.index; });
}

}  // namespace

void assign_entries(const ActivatedCloud& cloud, const std::vector<float>& weights,
                    const std::vector<float>& pixel_sizes, QuantisedCloud& quantised) {
  const std::vector<CanonicalShape> shapes = canonical_shapes(cloud);
  const auto codebook_of = [&](Codebook codebook) -> std::vector<float>& {
    return quantised.codebooks[static_cast<std::size_t>(codebook)];
  };
  const auto indices_of = [&](Codebook codebook) -> std::vector<std::uint32_t>& {
    return quantised.indices[static_cast<std::size_t>(codebook)];
  };
  std::vector<float>& scales = codebook_of(Codebook::kScale);
  const std::uint32_t words = codebook_words(Codebook::kScale, cloud.sh_degree);
  const std::size_t entries = scales.size() / words;
  std::vector<float> centroids(entries * kScaleDims);
  for (std::size_t e = 0; e < entries; ++e) {
    scale_point_of(&scales[e * words], &centroids[e * kScaleDims]);
  }
  const std::vector<float> before = centroids;
  assign_points(scale_points(shapes, weights), centroids, indices_of(Codebook::kScale));
  for (std::size_t e = 0; e < entries; ++e) {
    const float* point = &centroids[e * kScaleDims];
    // The way through logarithms and back rounds: entries that stay, stay to the bit.
    const bool stays = std::equal(point, point + kScaleDims, &before[e * kScaleDims]);
    if (!stays) scale_entry_of(point, &scales[e * words]);
  }
  indices_of(Codebook::kRotation) =
      nearest_rotations(shapes, pixel_sizes, codebook_of(Codebook::kRotation));
  for (const Codebook codebook : {Codebook::kDc, Codebook::kSh}) {
    if (codebook_of(codebook).empty()) continue;
    assign_points(colour_points(cloud, weights, codebook), codebook_of(codebook),
                  indices_of(codebook));
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    quantised.opacities[i] = opacity_code(cloud.gaussians[i].opacity);
  }
}

}  // namespace sgs
