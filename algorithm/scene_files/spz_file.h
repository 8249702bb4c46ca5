// Scenes of Niantic's .spz, versions 1 to 4.
#pragma once

#include <string>
#include <string_view>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// A header of 16 B, then all centres (24 bits a coordinate; version 1: half precision), opacities,
// colours, scales (8 bits each), quaternions (8 bits a component; from version 3 on the three
// smaller ones in 10 bits each) and SH coefficients (8 bits), in one gzip stream or bare. Version
// 4: a header of 32 B, and a zstd stream for each of these. Numbers come as they are stored: the
// format does not say which way its axes point. Throws InputError for other versions, SH degree 4,
// sizes that do not fit the header, damaged streams, and as decoded_scene does.
SceneContents read_spz(const std::string& path, const SceneReadOptions& options);

// The same of bytes within another file. origin: that file and the place, for messages.
SceneContents read_spz_bytes(const std::string& origin, std::string_view bytes,
                             const SceneReadOptions& options);

}  // namespace sgs
