// The formats of image files, one source file each.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// OpenEXR pictures.

// The file that holds `image`, of at least one pixel, as channels R, G, B of 32-bit float, ZIP
// compression; values are kept bit for bit.
std::string encode_exr(const Image& image);

// Reads the channels R, G, B of a single-part file, of any pixel type, inside its data window.
// Throws InputError: not an OpenEXR file, damaged, channels missing or subsampled, a side above
// 65,535 px.
Image read_exr(const std::string& path);

// Portable float maps.

// The file that holds `image` as "PF", little-endian, bottom row first as the format wants; values
// are kept bit for bit.
std::string encode_pfm(const Image& image);

// Reads "PF" (colour) or "Pf" (grey, to all three channels) of either byte order; values are
// multiplied by the magnitude of the header's scale. Throws InputError: not a PFM, a size that does
// not agree with the length of the file, a scale of 0.
Image read_pfm(const std::string& path);

// PNG pictures.

// The file that holds `image`, of at least one pixel, with 8 bits a channel: values clamped to
// [0, 1] (NaN: 0), times 255, rounded; no gamma, the file says sRGB.
std::string encode_png(const Image& image);

// True if both give the same file.
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

// JPEG pictures.

// Reads a grey or colour JPEG to values in [0, 1] as stored, alpha 1; an orientation that EXIF
// notes is not applied. Throws InputError: not a JPEG, four colour components (CMYK), cut off or
// damaged, or shorter than its size in pixels can be packed into.
RgbaImage read_jpeg(const std::string& path);

// Throws InputError as read_jpeg does, but looks at no pixel.
ImageHeader read_jpeg_header(const std::string& path);

// WebP pictures.

// Reads one that does not move, lossy or lossless, to values in [0, 1] as stored. Throws
// InputError: not a WebP, an animation, cut off or damaged, or far shorter than its size in pixels
// asks for.
RgbaImage read_webp(const std::string& path);

// Its samples as they are stored.
struct RgbaSamples {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // [height, width, 4]

  const std::uint8_t* pixel(std::uint64_t index) const { return &rgba[4 * index]; }
};

// Those of a whole file in memory. origin: for messages. Throws InputError as read_webp does.
RgbaSamples decode_webp(const std::string& origin, const std::string& bytes);

// Throws InputError as read_webp does, but looks at no pixel.
ImageHeader read_webp_header(const std::string& path);

// TIFF pictures.

// Reads the first picture of a file as 8 bits a channel to values in [0, 1]. Throws InputError: not
// a TIFF, a kind that libtiff cannot make RGBA of (floating point), an orientation other than the
// top row first, cut off or damaged, or shorter than its size in pixels can be packed into.
RgbaImage read_tiff(const std::string& path);

// Throws InputError as read_tiff does, but looks at no pixel.
ImageHeader read_tiff_header(const std::string& path);

}  // namespace sgs
