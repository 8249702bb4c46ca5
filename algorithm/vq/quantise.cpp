// The points of each codebook, what k-means makes of them, and the assignment to codebooks that are
// there.
#include "algorithm/vq/quantise.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "algorithm/vq/kmeans.h"
#include "algorithm/vq/nearest.h"
#include "algorithm/vq/rotation_codebook.h"
#include "algorithm/vq/vq_points.h"

namespace sgs {
namespace {

class Quantiser {
 public:
  Quantiser(const VqConfig& config, const VqProgress& progress, QuantisedCloud& out)
      : config_(config), progress_(progress), out_(out) {}

  // Trains a codebook. entry_of(centroid, entry): from a centroid to the words of an entry.
  template <class EntryOf>
  void train(Codebook codebook, const PointSet& points, std::uint32_t words, EntryOf&& entry_of) {
    const auto id = static_cast<std::size_t>(codebook);
    KMeansResult result = kmeans(points, config_of(codebook), progress_of(codebook));
    const auto dims = static_cast<std::size_t>(points.dims);
    const std::size_t entries = result.centroids.size() / dims;
    out_.codebooks[id].resize(entries * words);
    for (std::size_t e = 0; e < entries; ++e) {
      entry_of(result.centroids.data() + e * dims, out_.codebooks[id].data() + e * words);
    }
    out_.indices[id] = std::move(result.labels);
  }

  void train_rotations(const std::vector<CanonicalShape>& shapes, const std::vector<float>& weights,
                       const std::vector<float>& pixel_sizes) {
    constexpr auto kId = static_cast<std::size_t>(Codebook::kRotation);
    RotationCodebook rotations =
        sgs::train_rotations(shapes, weights, pixel_sizes, config_of(Codebook::kRotation),
                             progress_of(Codebook::kRotation));
    out_.codebooks[kId] = std::move(rotations.quats);
    out_.indices[kId] = std::move(rotations.labels);
  }

 private:
  KMeansConfig config_of(Codebook codebook) const {
    constexpr std::size_t kLeastTraining = 1U << 16, kTrainingPerEntry = 64;
    KMeansConfig config;
    config.entries = config_.entries(codebook);
    config.iterations = config_.iterations;
    config.seed = config_.seed + 16 * static_cast<std::uint64_t>(codebook);
    config.training_points = std::max(kLeastTraining, kTrainingPerEntry * config.entries);
    return config;
  }
  KMeansProgress progress_of(Codebook codebook) const {
    return [this, codebook](std::uint32_t iteration, double error) {
      if (progress_) progress_(codebook, iteration, error);
    };
  }

  const VqConfig& config_;
  const VqProgress& progress_;
  QuantisedCloud& out_;
};

}  // namespace

QuantisedCloud quantise(const ActivatedCloud& cloud, const std::vector<float>& weights,
                        const std::vector<float>& pixel_sizes, const VqConfig& config,
                        const VqProgress& progress) {
  QuantisedCloud out;
  for (const Gaussian<float>& g : cloud.gaussians) out.opacities.push_back(opacity_code(g.opacity));
  const std::vector<CanonicalShape> shapes = canonical_shapes(cloud);

  Quantiser quantiser(config, progress, out);
  quantiser.train(Codebook::kScale, scale_points(shapes, weights),
                  codebook_words(Codebook::kScale, cloud.sh_degree), scale_entry_of);
  quantiser.train_rotations(shapes, weights, pixel_sizes);
  const auto train_colours = [&](Codebook codebook) {
    const std::uint32_t words = codebook_words(codebook, cloud.sh_degree);
    quantiser.train(
        codebook, colour_points(cloud, weights, codebook), words,
        [&](const float* centroid, float* entry) { std::copy_n(centroid, words, entry); });
  };
  train_colours(Codebook::kDc);
  if (cloud.sh_degree > 0) train_colours(Codebook::kSh);
  return out;
}

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
