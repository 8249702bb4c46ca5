// The built-in scene `outdoor`: a landscape as a trained, unbounded capture would leave it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/scene_builder.h"

namespace sgs {

// Large far Gaussians all around, some lost ones up to 20,000 units away. `to_sun` is unit.
std::vector<ScenePart> sky_parts(const glm::dvec3& to_sun, double share);

// Artefacts of training: faint floaters close to the cameras, needles of axis ratio 10^3 to 10^6,
// and Gaussians with an opacity below 1/255.
std::vector<ScenePart> artefact_parts(double share);

// `count` Gaussians: most within 60 units, mountains at 900, sky at some thousands, outliers to
// 20,000; wires of axis ratio 10^6; floaters near the cameras; some that no view can show.
BuiltinScene make_outdoor_scene(std::uint64_t count);

// At eye height over the meadow to the pond, and on towards the house.
BuiltinPath outdoor_walk();

}  // namespace sgs
