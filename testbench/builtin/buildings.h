// House, tower, fence and power line of the built-in scene `outdoor`.
#pragma once

#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

std::vector<ScenePart> building_parts(double share);
std::vector<Capsule> building_occluders();

}  // namespace sgs
