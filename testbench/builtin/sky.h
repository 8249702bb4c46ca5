// Sky, outliers and artefacts of the built-in scene `outdoor`.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

// Large far Gaussians all around, some lost ones up to 20,000 units away. `to_sun` is unit.
std::vector<ScenePart> sky_parts(const glm::dvec3& to_sun, double share);

// Artefacts of training: faint floaters close to the cameras, needles of axis ratio 10^3 to 10^6,
// and Gaussians with an opacity below 1/255.
std::vector<ScenePart> artefact_parts(double share);

}  // namespace sgs
