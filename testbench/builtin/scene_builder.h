// Turns parts of a built-in scene into a cloud of a given size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "testbench/builtin/lighting.h"
#include "testbench/builtin/random.h"
#include "testbench/builtin/surfel.h"

namespace sgs {

// Which Gaussian of a part is wanted.
struct PartSample {
  std::uint64_t index = 0;  // 0 .. count - 1
  std::uint64_t count = 1;  // Gaussians that the part gets
};

// Factor on the size of loose Gaussians, such as blades of grass: 1 up to `usual` of them, then
// less so that more of them do not cover more.
inline double thinning(const PartSample& sample, double usual) {
  return std::min(1.0, std::sqrt(usual / static_cast<double>(sample.count)));
}

// A part makes each of its Gaussians from its index and a random stream of its own.
struct ScenePart {
  double share = 1;  // its part of the scene's Gaussians, relative to the other parts
  std::function<Surfel(const PartSample&, Random&)> surfel;
};

// Makes `count` Gaussians of SH degree 3, dealt out to `parts` by share, in an order without
// pattern, as training leaves them. Runs on all threads; the result does not depend on their
// number.
GaussianCloud build_scene(const std::vector<ScenePart>& parts, const Lighting& lighting,
                          std::uint64_t count, std::uint64_t seed);

}  // namespace sgs
