// Scenes of PlayCanvas: SOG, version 2, in a folder or a .zip, and streamed in levels of detail.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

constexpr const char* kSogMeta = "meta.json";
constexpr const char* kStreamedSogMeta = "lod-meta.json";

// One of the two files above by its name, or a folder that holds it.
bool is_sog_folder(const std::string& path);
bool is_streamed_sog(const std::string& path);

// meta.json and WebP pictures, a pixel a Gaussian: centres (16 bits a coordinate, of a logarithm),
// quaternions (the three smaller components in 8 bits each), scales and colours (8-bit indices of
// codebooks), opacities, and SH coefficients (indices of a palette). path: of a zip, of meta.json,
// or of its folder. Throws InputError for other versions, what is missing or damaged, pictures with
// too few pixels, and as decoded_scene does.
SceneContents read_sog(const std::string& path, const SceneReadOptions& options);

// lod-meta.json and the SOG folders that it names: those of one level. Throws InputError also for a
// level that it has not.
SceneContents read_streamed_sog(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs
