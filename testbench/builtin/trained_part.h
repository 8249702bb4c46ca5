// What training makes of Gaussians that cover a surface evenly.
#pragma once

#include "testbench/builtin/scene_builder.h"

namespace sgs {

// `even`, its Gaussians as the original's training leaves them (Kerbl et al. 2023): sizes and
// aspects spread over decades, flat, off the surface and tilted, and many of them faint.
ScenePart trained_part(ScenePart even);

}  // namespace sgs
