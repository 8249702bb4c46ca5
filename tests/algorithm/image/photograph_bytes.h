// WebP and TIFF files for tests, of 4 bytes a pixel: red, green, blue, alpha, not multiplied by it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sgs::test {

// Lossless.
std::string webp_bytes(int width, int height, const std::vector<std::uint8_t>& rgba);

struct TiffKind {
  int bits = 8;  // a channel: 8 or 16
  bool big_endian = false;
  bool deflated = true;
  int orientation = 1;
};

std::string tiff_bytes(int width, int height, const std::vector<std::uint8_t>& rgba,
                       const TiffKind& kind = {});

}  // namespace sgs::test
