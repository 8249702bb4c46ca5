// The rocket of the built-in scene `object`.
#pragma once

#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

// A rocket 2.5 units high that stands on its fins at the origin; shares add up to about `share`.
std::vector<ScenePart> toy_rocket_parts(double share);

// The bodies that cast the rocket's shadow.
std::vector<Capsule> toy_rocket_occluders();

}  // namespace sgs
