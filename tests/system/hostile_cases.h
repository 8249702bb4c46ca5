// Seeded hostile scenes: each extreme that a scene or a camera can be, alone or several at once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

struct HostileCase {
  std::string what;  // extremes in it, for messages
  GaussianCloud cloud;
  std::vector<Camera> cameras;
  std::string refused;  // word with which every command refuses it; empty: it must be drawn
};

// How many extremes there are. Seeds below have one each, in a fixed order; seeds from here on a
// mixture of two to four.
std::uint64_t hostile_extremes();

HostileCase hostile_case(std::uint64_t seed);

}  // namespace sgs::test
