// Writing scenes as .ply in the form of the original 3D Gaussian Splatting code.
#pragma once

#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// Writes `cloud` as a binary little-endian PLY with the properties x y z nx ny nz f_dc_* f_rest_*
// opacity scale_* rot_*, all float, the normals zero, f_rest channel-major. Values go out bit for
// bit. Where notes, those of the scene, hold kAntialiasedNote, a comment says it of the file. It
// appears under `path` once it is complete. Throws InputError when `path` cannot be
// created or the arrays of `cloud` disagree in length, std::runtime_error when writing fails.
void write_ply(const std::string& path, const GaussianCloud& cloud,
               const std::vector<std::string>& notes = {});

}  // namespace sgs
