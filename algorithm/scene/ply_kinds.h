// What kind of PLY file a header is of. Some look like trained scenes but are drawn by rules of
// their own: these are refused by name.
#pragma once

#include <string>
#include <vector>

#include "algorithm/scene/ply_header.h"

namespace sgs {

// True for the packed form of SuperSplat and splat-transform.
bool is_compressed_ply(const PlyHeader& header);

// Throws InputError where the file is a point cloud, or where its pictures are not those of plain
// 3D Gaussians: 2DGS, Scaffold-GS, spherical Gaussians, other kernels, Gaussians that move.
void refuse_other_kinds(const std::string& path, const PlyHeader& header, const PlyElement& vertex);

// A sentence on each property and element that changes the scene or that is skipped, and on a
// comment that asks for another rasteriser.
std::vector<std::string> notes_on_ply(const PlyHeader& header, const PlyElement& vertex);

// True where a comment says that the scene was trained with the 2D filter of Mip-Splatting, and the
// note on that.
bool is_antialiased(const PlyHeader& header);
constexpr const char* kAntialiasedNote =
    "it was trained for an anti-aliased rasteriser, and is drawn by the original one";

}  // namespace sgs
