// How densely points lie.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace sgs {

// Of each point the root of the mean square distance to its three nearest others, world units; to
// fewer where there are fewer, 0 where there is none.
std::vector<float> neighbour_distances(const std::vector<glm::vec3>& points);

}  // namespace sgs
