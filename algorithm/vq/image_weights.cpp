// Weights from pictures and from sizes.
#include "algorithm/vq/image_weights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "algorithm/render/group_state.h"
#include "algorithm/render/splat_bins.h"
#include "algorithm/render/splat_sequence.h"
#include "algorithm/scene/cameras.h"

namespace sgs {
namespace {

constexpr std::size_t kMostCameras = 64;
constexpr double kMostPixels = 1 << 20;
constexpr double kSeenShare = 0.7;

// Sums in units of 2^-32, which come out the same in whatever order threads add to them.
class FixedPointSums {
 public:
  explicit FixedPointSums(std::size_t count) : sums_(count) {}
  void add(std::size_t index, double value) {
    sums_[index].fetch_add(static_cast<std::uint64_t>(value * 0x1p32), std::memory_order_relaxed);
  }
  double operator[](std::size_t index) const {
    return static_cast<double>(sums_[index].load()) * 0x1p-32;
  }

 private:
  std::vector<std::atomic<std::uint64_t>> sums_;
};

// Blends a tile and notes what each splat takes of the light in it.
class WatchedTile {
 public:
  WatchedTile(const PixelRect& pixels, int width_px, int height_px)
      : state_(pixels, width_px, height_px), before_(state_.subtile_count() * kSubtilePixels, 1) {}

  bool saturated() const { return state_.saturated(); }

  void blend(const Splat& splat, FixedPointSums& sums) {
    double squares = 0;
    state_.blend(splat, [&](std::size_t at, const SubtileState& subtile) {
      for (std::size_t lane = 0; lane < kSubtilePixels; ++lane) {
        float& before = before_[at * kSubtilePixels + lane];
        const double taken = static_cast<double>(before) - subtile.transmittance[lane];
        // Pixels outside the frame begin with no light.
        if (subtile.contributors[lane] > 0) squares += taken * taken;
        before = subtile.transmittance[lane];
      }
    });
    sums.add(splat.index, squares);
  }

 private:
  GroupState state_;
  std::vector<float> before_;  // T of each pixel after the last blend
};

void blend_run(const CellGrid& grid, const Splat* splats, std::size_t count,
               std::vector<WatchedTile>& tiles, FixedPointSums& sums) {
  const SplatBins bins = bin_splats(grid, splats, count);
  tbb::parallel_for(std::size_t{0}, grid.size(), [&](std::size_t tile) {
    for (std::size_t i = bins.first[tile]; i != bins.first[tile + 1]; ++i) {
      if (tiles[tile].saturated()) return;
      tiles[tile].blend(splats[bins.entries[i]], sums);
    }
  });
}

void add_view(const ActivatedCloud& cloud, const Camera& camera, FixedPointSums& sums) {
  constexpr std::size_t kBatchSplats = 32768;
  const View<float> view = make_view<float>(camera);
  const CellGrid grid = cell_grid(view.width, view.height, kTilePx);
  std::vector<WatchedTile> tiles;
  for (const PixelRect& pixels : pixel_groups(view.width, view.height, kTilePx)) {
    tiles.emplace_back(pixels, view.width, view.height);
  }
  SplatSequence sequence(view, cloud);
  std::vector<Splat> batch;
  while (!sequence.at_end() && std::any_of(tiles.begin(), tiles.end(),
                                           [](const auto& tile) { return !tile.saturated(); })) {
    sequence.next(kBatchSplats, batch);
    for (std::size_t begin = 0; begin != batch.size();) {
      const std::size_t count = binnable(grid, batch, begin);
      blend_run(grid, batch.data() + begin, count, tiles, sums);
      begin += count;
    }
  }
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
