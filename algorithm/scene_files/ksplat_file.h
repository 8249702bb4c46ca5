// Scenes of GaussianSplats3D's web viewer: .ksplat.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// A header of 4 KiB, headers of sections of 1 KiB each, then the sections: buckets of Gaussians
// around a centre, and a record for each. Compression 0 keeps floats; 1 has centres of 16 bits
// within the bucket and half precision; 2 has SH coefficients of 8 bits, too. Throws InputError
// for other versions and compressions, sizes that do not fit the headers, and as decoded_scene
// does.
SceneContents read_ksplat(const std::string& path, const SceneReadOptions& options);

}  // namespace sgs
