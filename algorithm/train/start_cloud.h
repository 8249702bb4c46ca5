// The cloud that training begins with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

struct StartConfig {
  double opacity = 0.5;      // each Gaussian's; the original has 0.1
  double scale_share = 0.5;  // share of the distance to its neighbours; the original has 1
};

// The points that the data set brings; where it brings none `count` random ones in box_to_fill().
// Throws InputError where it brings fewer than a size can be told from.
std::vector<SfmPoint> points_to_start_at(const Dataset& dataset, std::size_t count,
                                         std::uint64_t seed);

// Round Gaussians of degree 0 at points, as large as these lie apart: the first `most` of them in a
// random order where there are more.
GaussianCloud start_at_points(const std::vector<SfmPoint>& points, std::size_t most,
                              const StartConfig& config, std::uint64_t seed);

// `count` points of random colours, even in a box.
std::vector<SfmPoint> random_points(const Extent& box, std::size_t count, std::uint64_t seed);

// The box that holds what the cameras look at: the one that the data set states; else a cube around
// the point that the optical axes pass nearest to, whose half side is a third of the mean distance
// of the cameras from it.
Extent box_to_fill(const Dataset& dataset);

// For each point the root of the mean square distance to its three nearest others, world units; to
// fewer where there are fewer, 0 where there is none.
std::vector<float> neighbour_distances(const std::vector<glm::vec3>& points);

}  // namespace sgs
