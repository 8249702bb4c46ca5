// Reading trained scenes from .ply files in the form of the original 3D Gaussian Splatting code.
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

struct PlyReadOptions {
  // Leave out Gaussians with NaN, infinite values, values beyond gaussian_cloud.h or a zero
  // quaternion instead of refusing the file.
  bool drop_invalid = false;
};

struct PlyReadResult {
  GaussianCloud cloud;
  std::uint64_t dropped_invalid = 0;  // Gaussians left out because of drop_invalid
};

// Reads the element `vertex` of the PLY file at `path`: x y z, f_dc_0..2, f_rest_0..k-1 (k = 0, 9,
// 24 or 45: SH degree 0 to 3), opacity, scale_0..2, rot_0..3 (w, x, y, z), in any order, among any
// other properties, in ascii or binary of either byte order, of any scalar type (converted to
// float). Other elements are skipped. Throws InputError: not a PLY, an unknown format, a missing,
// duplicate or list property, a count that the file cannot hold, a truncated file or bytes behind
// its last record, text that is no number, or (unless dropped) a value that is not finite or too
// large to be drawn (gaussian_cloud.h), or a quaternion of length zero.
PlyReadResult read_ply(const std::string& path, const PlyReadOptions& options = {});

}  // namespace sgs
