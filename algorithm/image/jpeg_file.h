// JPEG pictures.
#pragma once

#include <string>

#include "algorithm/image/image_header.h"
#include "algorithm/image/rgba_image.h"

namespace sgs {

// Reads a grey or colour JPEG to values in [0, 1] as stored, alpha 1; an orientation that EXIF notes
// is not applied. Throws InputError: not a JPEG, four colour components (CMYK), cut off or damaged,
// or shorter than its size in pixels can be packed into.
RgbaImage read_jpeg(const std::string& path);

// Throws InputError as read_jpeg does, but looks at no pixel.
ImageHeader read_jpeg_header(const std::string& path);

}  // namespace sgs
