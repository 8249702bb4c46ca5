// Scenes as SuperSplat and splat-transform compress them: .compressed.ply.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// Elements chunk (bounds of 256 Gaussians each), vertex (four words a Gaussian: 11, 10 and 11 bits
// of position and of scale within the bounds, 10 bits for each of the three smaller components of
// the quaternion, 8 bits for colour and opacity) and perhaps sh (8 bits a coefficient). Throws
// InputError as read_ply_header does, for missing properties, counts that do not fit each other,
// bytes behind the last record, and as decoded_scene does.
SceneContents read_compressed_ply(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs
