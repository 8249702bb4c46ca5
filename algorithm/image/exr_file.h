// OpenEXR pictures.
#pragma once

#include <string>

#include "algorithm/image/image.h"

namespace sgs {

// The file that holds `image`, of at least one pixel, as channels R, G, B of 32-bit float, ZIP
// compression; values are kept bit for bit.
std::string encode_exr(const Image& image);

// Reads the channels R, G, B of a single-part file, of any pixel type, inside its data window.
// Throws InputError: not an OpenEXR file, damaged, channels missing or subsampled, a side above
// 65,535 px.
Image read_exr(const std::string& path);

}  // namespace sgs
