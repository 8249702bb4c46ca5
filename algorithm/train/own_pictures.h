// Targets where there are no photographs: the scene's own reference pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"

namespace sgs {

// Before black, opaque; what is brighter than 1 becomes 1, as in any photograph. cloud: copied.
Photographs own_pictures(const ActivatedCloud& cloud, std::vector<Camera> cameras);

// `count` cameras, each somewhere between two of the given ones, drawn: on the line between their
// centres, turned as far on the shortest way, with the size and focal lengths of the first of the
// two. Throws InputError where fewer than two are given.
std::vector<Camera> cameras_between(const std::vector<Camera>& cameras, std::size_t count,
                                    std::uint64_t seed);

}  // namespace sgs
