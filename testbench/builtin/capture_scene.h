// The built-in scene `capture`: what training makes of photographs taken once round a thing.
#pragma once

#include <cstdint>

#include "testbench/builtin/builtin_scene.h"

namespace sgs {

// `count` Gaussians in COLMAP's unit: a rocket on a square, trees and houses around it, hills, sky.
// Cameras stand on a ring about 4 units from the rocket, 980x545 px as in Tanks and Temples.
BuiltinScene make_capture_scene(std::uint64_t count);

// Once round the rocket.
BuiltinPath capture_ring();

}  // namespace sgs
