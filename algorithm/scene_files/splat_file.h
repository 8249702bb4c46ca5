// Scenes of antimatter15's web viewer: .splat.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// 32 B a Gaussian, nothing before or behind: centre and scale as floats, colour and opacity of 8
// bits, quaternion of 8 bits a component. Throws InputError for other sizes, and as decoded_scene
// does.
SceneContents read_splat(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs
