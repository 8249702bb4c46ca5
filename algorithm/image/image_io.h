// Image files: pictures by extension (.exr, .pfm, .png), photographs by their first bytes.
#pragma once

#include <string>

#include "algorithm/files/output_file.h"
#include "algorithm/image/image.h"

namespace sgs {

// Writes `image` to `path` in the format of its extension: .exr (float RGB), .pfm (float,
// little-endian) or .png (8 bits: values clamped to [0, 1], times 255, rounded; no gamma, because
// the colours of 3D Gaussian Splatting are display-referred already). Throws InputError for another
// extension, an image without pixels or a path that cannot be created, std::runtime_error when
// writing fails.
void write_image(const std::string& path, const Image& image);

// The same without the last step: the caller commits `to`.
void write_image(OutputFile& to, const Image& image);

// Throws InputError for an extension that write_image() refuses.
void check_image_name(const std::string& path);

// Reads such a file: .exr with channels R, G, B; .pfm of either byte order, colour or grey; .png of
// any kind, to [0, 1], transparent pixels over black (image_formats.h). Throws InputError with
// file, place, what was found and what was expected.
Image read_image(const std::string& path);

// PNG, JPEG, WebP and TIFF pictures, told apart by their first bytes.

// As read_png_rgba, read_jpeg, read_webp or read_tiff. Throws InputError as they do, and for a file
// of another kind.
RgbaImage read_photograph(const std::string& path);

// The header alone, in the same way.
ImageHeader read_photograph_header(const std::string& path);

}  // namespace sgs
