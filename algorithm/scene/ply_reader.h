// Reading trained scenes from .ply files in the form of the original 3D Gaussian Splatting code.
#pragma once

#include <string>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// Reads the element `vertex` of the PLY file at `path`: x y z, f_dc_0..2, f_rest_0..k-1 (k = 0, 9,
// 24 or 45: SH degree 0 to 3), opacity, scale_0..2, rot_0..3 (w, x, y, z), in any order, in ascii
// or binary of either byte order, of any scalar type (converted to float). filter_3D is baked into
// scales and opacity (ply_vertex.h). Other properties and elements are skipped and noted, unless
// they say that the picture is not that of plain 3D Gaussians (ply_header.h). Throws InputError:
// not a PLY, an unknown format, a missing, duplicate or list property, a count that the file cannot
// hold, a truncated file or bytes behind its last record, text that is no number, or (unless
// dropped) a value that activation makes no use of or that is too large to be drawn
// (gaussian_cloud.h), or a quaternion of length zero.
SceneContents read_ply(const std::string& path, const SceneReadOptions& options = {});

}  // namespace sgs
