// Water, lilies and reeds of the built-in scene `outdoor`.
#pragma once

#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

std::vector<ScenePart> pond_parts(double share);

}  // namespace sgs
