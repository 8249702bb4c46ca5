// Image files by extension: .exr, .pfm, .png.
#pragma once

#include <string>

#include "algorithm/image/image.h"

namespace sgs {

// Writes `image` to `path` in the format of its extension: .exr (float RGB), .pfm (float,
// little-endian) or .png (8 bits: values clamped to [0, 1], times 255, rounded; no gamma, because
// the colours of 3D Gaussian Splatting are display-referred already). Throws InputError for another
// extension, an image without pixels or a path that cannot be created.
void write_image(const std::string& path, const Image& image);

// Reads such a file: .exr with channels R, G, B; .pfm of either byte order, colour or grey; .png of
// any kind, to [0, 1], transparent pixels over black (png_file.h). Throws InputError with file,
// place, what was found and what was expected.
Image read_image(const std::string& path);

}  // namespace sgs
