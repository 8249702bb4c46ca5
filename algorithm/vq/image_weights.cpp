// Weights from pictures and from sizes.
#include "algorithm/vq/image_weights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "algorithm/render/blend_pass.h"
#include "algorithm/scene/camera.h"
#include "algorithm/vq/fixed_point_sums.h"

namespace sgs {
namespace {

constexpr std::size_t kMostCameras = 64;
constexpr double kMostPixels = 1 << 20;
constexpr double kSeenShare = 0.7;

// Adds to each Gaussian's sum what it takes of the light of a view: (T alpha)^2 over its pixels.
void add_view(const ActivatedCloud& cloud, const Camera& camera, FixedPointSums& sums) {
  blend_scene(make_view<float>(camera), cloud, [&](GroupState& tile, const Splat& splat) {
    double squares = 0;
    tile.blend(splat, each_pixel([&](const PixelBlend& pixel) {
                 const double taken = static_cast<double>(pixel.before) - pixel.after;
                 squares += taken * taken;
               }));
    sums.add(splat.index, squares);
  });
}

Camera at_most(const Camera& camera, double pixels) {
  const double shrink = std::sqrt(pixels / (static_cast<double>(camera.width) * camera.height));
  if (shrink >= 1) return camera;
  return scaled_to(camera, std::max(1, static_cast<int>(camera.width * shrink)),
                   std::max(1, static_cast<int>(camera.height * shrink)));
}

std::vector<double> seen_weights(const ActivatedCloud& cloud, const std::vector<Camera>& cameras) {
  FixedPointSums sums(cloud.size());
  const std::size_t used = std::min(cameras.size(), kMostCameras);
  for (std::size_t c = 0; c < used; ++c) {
    add_view(cloud, at_most(cameras[c * cameras.size() / used], kMostPixels), sums);
  }
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = sums[i];
  return weights;
}

std::vector<double> size_weights(const ActivatedCloud& cloud) {
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    const double x = g.scale.x, y = g.scale.y, z = g.scale.z;
    const double weight = g.opacity * (x * y + y * z + z * x);
    weights[i] = std::isfinite(weight) ? weight : 0;  // scales that overflowed are never drawn
  }
  std::vector<double> sorted = weights;
  const auto cap = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100);
  std::nth_element(sorted.begin(), cap, sorted.end());
  for (double& weight : weights) weight = std::min(weight, *cap);
  return weights;
}

// Scales to mean `mean`; leaves weights that add up to nothing, or to no number, at 0.
void scale_to_mean(std::vector<double>& weights, double mean) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const bool usable = sum > 0 && std::isfinite(sum);
  const double factor = usable ? mean * static_cast<double>(weights.size()) / sum : 0;
  for (double& weight : weights) weight = usable ? weight * factor : 0;
}

}  // namespace

std::vector<float> image_weights(const ActivatedCloud& cloud, const std::vector<Camera>& cameras) {
  if (cloud.size() == 0) return {};
  std::vector<double> seen = seen_weights(cloud, cameras), anywhere = size_weights(cloud);
  scale_to_mean(seen, kSeenShare);
  scale_to_mean(anywhere, cameras.empty() ? 1 : 1 - kSeenShare);
  constexpr double kLeast = 1e-6;  // nobody is worth nothing
  std::vector<float> weights(cloud.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = static_cast<float>(seen[i] + anywhere[i] + kLeast);
  }
  return weights;
}

std::vector<float> pixel_sizes(const ActivatedCloud& cloud, const std::vector<Camera>& cameras) {
  std::vector<float> sizes(cloud.size(), 0.0F);
  if (cameras.empty()) return sizes;
  tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
    double least = std::numeric_limits<double>::infinity();
    for (const Camera& camera : cameras) {
      const double distance = glm::distance(glm::dvec3(cloud.gaussians[i].mean), camera.position);
      least = std::min(least, distance / std::max(camera.focal_x, camera.focal_y));
    }
    sizes[i] = static_cast<float>(least);
  });
  return sizes;
}

}  // namespace sgs
