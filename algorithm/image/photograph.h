// PNG and JPEG pictures, told apart by their first bytes.
#pragma once

#include <string>

#include "algorithm/image/image_header.h"
#include "algorithm/image/rgba_image.h"

namespace sgs {

// As read_png_rgba or read_jpeg. Throws InputError as they do, and for a file of another kind.
RgbaImage read_photograph(const std::string& path);

// As read_png_header or read_jpeg_header.
ImageHeader read_photograph_header(const std::string& path);

}  // namespace sgs
