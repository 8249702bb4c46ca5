// The points of each codebook, and what k-means makes of them.
#include "algorithm/vq/quantise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/vq/canonical_shape.h"
#include "algorithm/vq/kmeans.h"
#include "algorithm/vq/rotation_codebook.h"

namespace sgs {
namespace {

// Added to ratios of scales before the logarithm: below a fiftieth of the largest axis, thinner is
// not seen, and entries spent on it would be lost to others.
constexpr double kThinnest = 0.02;

// A length by the largest one, in [0, 1] also where both are 0 or have overflowed to infinity.
double ratio_of(float scale, float largest) {
  return scale == largest ? 1 : static_cast<double>(scale) / largest;
}

float log_ratio(float scale, float largest) {
  return static_cast<float>(std::log(ratio_of(scale, largest) + kThinnest));
}
float ratio_of_log(float value) {
  return static_cast<float>(std::clamp(std::exp(static_cast<double>(value)) - kThinnest, 0.0, 1.0));
}

// Points [N, dims] of which `fill(i, point, weight)` writes each.
template <class Fill>
PointSet make_points(const std::vector<float>& weights, std::uint32_t dims, Fill&& fill) {
  PointSet points;
  points.dims = static_cast<int>(dims);
  points.weights = weights;
  points.values.resize(weights.size() * dims);
  tbb::parallel_for(std::size_t{0}, weights.size(), [&](std::size_t i) {
    fill(i, points.values.data() + i * dims, points.weights[i]);
  });
  return points;
}

std::uint8_t opacity_code(float opacity) {
  constexpr float kLevels = 255;
  if (opacity < 1 / kLevels) return 0;
  return static_cast<std::uint8_t>(std::clamp(std::round(opacity * kLevels), 1.0F, kLevels));
}

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
  const std::size_t count = cloud.size();
  out.opacities.resize(count);
  std::vector<CanonicalShape> shapes(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    shapes[i] = canonical_shape(g.scale, g.quat);
    out.opacities[i] = opacity_code(g.opacity);
  });

  Quantiser quantiser(config, progress, out);
  const PointSet scales = make_points(weights, 2, [&](std::size_t i, float* point, float&) {
    point[0] = log_ratio(shapes[i].scale[1], shapes[i].scale[0]);
    point[1] = log_ratio(shapes[i].scale[2], shapes[i].scale[0]);
  });
  quantiser.train(Codebook::kScale, scales, 3, [](const float* centroid, float* entry) {
    entry[0] = 1;
    entry[1] = ratio_of_log(centroid[0]);
    entry[2] = ratio_of_log(centroid[1]);
  });

  quantiser.train_rotations(shapes, weights, pixel_sizes);

  const auto colours = [&](std::uint32_t first_word, std::uint32_t words) {
    return make_points(weights, words, [&](std::size_t i, float* point, float&) {
      for (std::uint32_t w = 0; w < words; ++w) {
        const std::uint32_t word = first_word + w;
        point[w] = cloud.sh(i)[word / 3][static_cast<int>(word % 3)];
      }
    });
  };
  const auto train_colours = [&](Codebook codebook, std::uint32_t first_word) {
    const std::uint32_t words = codebook_words(codebook, cloud.sh_degree);
    quantiser.train(
        codebook, colours(first_word, words), words,
        [&](const float* centroid, float* entry) { std::copy_n(centroid, words, entry); });
  };
  train_colours(Codebook::kDc, 0);
  if (cloud.sh_degree > 0) train_colours(Codebook::kSh, 3);
  return out;
}

}  // namespace sgs
