// The built-in scene `object`: a toy rocket on a chequered table.
#pragma once

#include <cstdint>

#include "testbench/builtin/builtin_scene.h"

namespace sgs {

// `count` Gaussians within 8 units of the origin, most of them within 2.7.
BuiltinScene make_object_scene(std::uint64_t count);

// Once round the rocket, looking down at it.
BuiltinPath object_turntable();

}  // namespace sgs
