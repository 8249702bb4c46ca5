// PNG pictures.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "algorithm/image/image.h"
#include "algorithm/image/image_header.h"
#include "algorithm/image/rgba_image.h"

namespace sgs {

// The file that holds `image`, of at least one pixel, with 8 bits a channel: values clamped to
// [0, 1] (NaN: 0), times 255, rounded; no gamma, the file says sRGB.
std::string encode_png(const Image& image);

// Whether both give the same file.
bool same_png(const Image& a, const Image& b);

// Reads a PNG of any kind as 8 bits a channel to values in [0, 1] as stored, whatever the file
// states of gamma, primaries or profiles. Throws InputError: not a PNG, damaged, or shorter than
// its size in pixels can be packed into.
RgbaImage read_png_rgba(const std::string& path);

// The same, transparent pixels blended over `background`.
Image read_png(const std::string& path, const glm::vec3& background = glm::vec3(0));

// has_alpha: also of a palette with transparent entries. Throws InputError as read_png_rgba does,
// but looks at no pixel.
ImageHeader read_png_header(const std::string& path);

}  // namespace sgs
