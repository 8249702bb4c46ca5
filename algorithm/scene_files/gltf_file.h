// Gaussians in glTF 2.0: .glb and .gltf with KHR_gaussian_splatting.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// All primitives with the extension of the scene that is shown, each moved by its node, from
// accessors of float or integers, or from an SPZ in a buffer view
// (KHR_gaussian_splatting_compression_spz_2). glTF has its y axis upward: the result is turned half
// about z, back to the axes of an INRIA .ply, as splat-transform turns it for glTF. Throws
// InputError for other kernels, colour spaces and compressions, nodes that do more than turn, move
// and scale alike, whatever does not fit its buffer, and as decoded_scene does.
SceneContents read_gltf(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs
