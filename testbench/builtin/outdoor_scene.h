// The built-in scene `outdoor`: a landscape as a trained, unbounded capture would leave it.
#pragma once

#include <cstdint>

#include "testbench/builtin/builtin_scene.h"

namespace sgs {

// `count` Gaussians: most within 60 units, mountains at 900, sky at some thousands, outliers to
// 20,000; wires of axis ratio 10^6; floaters near the cameras; some that no view can show.
BuiltinScene make_outdoor_scene(std::uint64_t count);

// At eye height over the meadow to the pond, and on towards the house.
BuiltinPath outdoor_walk();

}  // namespace sgs
