// Portable float maps.
#pragma once

#include <string>

#include "algorithm/image/image.h"

namespace sgs {

// The file that holds `image` as "PF", little-endian, bottom row first as the format wants; values
// are kept bit for bit.
std::string encode_pfm(const Image& image);

// Reads "PF" (colour) or "Pf" (grey, to all three channels) of either byte order; values are
// multiplied by the magnitude of the header's scale. Throws InputError: not a PFM, a size that does
// not agree with the length of the file, a scale of 0.
Image read_pfm(const std::string& path);

}  // namespace sgs
