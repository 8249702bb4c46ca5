
#include "algorithm/train/start_cloud.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <nanoflann.hpp>
#include <numeric>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "algorithm/train/counter_random.h"

namespace sgs {
namespace {

constexpr std::size_t kNeighbours = 3;

// As nanoflann wants to see points.
struct Points {
  const std::vector<glm::vec3>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::size_t>;

}  // namespace

std::vector<float> neighbour_distances(const std::vector<glm::vec3>& points) {
  std::vector<float> distances(points.size(), 0.0F);
  if (points.size() < 2) return distances;
  const Points adapted{points};
  Tree tree(3, adapted, nanoflann::KDTreeSingleIndexAdaptorParams());
  tree.buildIndex();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
    std::size_t found[kNeighbours + 1];
    float squares[kNeighbours + 1];
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      // The nearest one is the point itself, or one at the same place.
      const std::size_t count = tree.knnSearch(&points[i].x, kNeighbours + 1, found, squares);
      double sum = 0;
      for (std::size_t k = 1; k < count; ++k) sum += squares[k];
      distances[i] = static_cast<float>(std::sqrt(sum / static_cast<double>(count - 1)));
    }
  });
  return distances;
}

namespace {

// The scale of a Gaussian whose points all coincide, world units.
constexpr float kLeastScale = 1e-4F;

std::vector<SfmPoint> drawn(std::vector<SfmPoint> points, std::size_t most, std::uint64_t seed) {
  CounterRandom random{seed, RandomUse::kStart};
  const std::size_t count = std::min(most, points.size());
  if (count < points.size()) {
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(points[i], points[i + random.below(points.size() - i)]);
    }
    points.resize(count);
  }
  return points;
}

// Nearest to all lines in the least squares: sum (I - d d^T) (p - o) = 0.
glm::dvec3 nearest_to_axes(const std::vector<DatasetView>& views) {
  glm::dmat3 sum(0.0);
  glm::dvec3 right(0.0), mean(0.0);
  for (const DatasetView& view : views) {
    const glm::dvec3 along = view.camera.world_from_camera[2];
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(along, along);
    sum += across;
    right += across * view.camera.position;
    mean += view.camera.position / static_cast<double>(views.size());
  }
  // Parallel axes meet nowhere.
  const double spread = glm::determinant(sum / static_cast<double>(views.size()));
  return spread < 1e-6 ? mean : glm::inverse(sum) * right;
}

}  // namespace

std::vector<SfmPoint> points_to_start_at(const Dataset& dataset, std::size_t count,
                                         std::uint64_t seed) {
  constexpr std::size_t kFewest = 4;  // a size is the distance to the three nearest others
  if (dataset.points.empty()) return random_points(box_to_fill(dataset), count, seed);
  if (dataset.points.size() < kFewest) {
    throw InputError(
        fmt::format("{}: got {} points to begin with ({}), expected {} or "
                    "more, or none: then random ones are made",
                    dataset.folder, dataset.points.size(), dataset.layout, kFewest));
  }
  return dataset.points;
}

GaussianCloud start_at_points(const std::vector<SfmPoint>& points, std::size_t most,
                              const StartConfig& config, std::uint64_t seed) {
  const std::vector<SfmPoint> chosen = drawn(points, most, seed);
  GaussianCloud cloud;
  cloud.resize(chosen.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) cloud.means[i] = chosen[i].position;
  const std::vector<float> apart = neighbour_distances(cloud.means);
  const auto opacity_logit = static_cast<float>(logit(config.opacity));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const float scale = std::max(static_cast<float>(config.scale_share) * apart[i], kLeastScale);
    cloud.log_scales[i] = glm::vec3(std::log(scale));
    cloud.quats[i] = {1, 0, 0, 0};
    cloud.opacity_logits[i] = opacity_logit;
    cloud.sh_coeffs[i] = (chosen[i].colour - 0.5F) / static_cast<float>(kShFactor[0]);
  }
  return cloud;
}

std::vector<SfmPoint> random_points(const Extent& box, std::size_t count, std::uint64_t seed) {
  std::vector<SfmPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    CounterRandom random{seed, RandomUse::kStart, 1, i};
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box.min[axis], high = box.max[axis];
      points[i].position[axis] = static_cast<float>(low + (high - low) * random.uniform());
    }
    for (int channel = 0; channel < 3; ++channel) {
      points[i].colour[channel] = static_cast<float>(random.uniform());
    }
  }
  return points;
}

Extent box_to_fill(const Dataset& dataset) {
  if (dataset.bounds) return *dataset.bounds;
  const glm::dvec3 middle = nearest_to_axes(dataset.views);
  double distance = 0;
  for (const DatasetView& view : dataset.views) {
    distance += glm::distance(view.camera.position, middle);
  }
  const double half = distance / (3 * static_cast<double>(dataset.views.size()));
  return {glm::vec3(middle - half), glm::vec3(middle + half)};
}

}  // namespace sgs
