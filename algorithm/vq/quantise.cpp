// The points of each codebook, and what k-means makes of them.
#include "algorithm/vq/quantise.h"

#include <algorithm>

#include "algorithm/vq/canonical_shape.h"
#include "algorithm/vq/kmeans.h"
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

}  // namespace sgs
