// JPEG files for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sgs::test {

// A JPEG of `width` x `height` px, `components` bytes a pixel: 1 grey, 3 RGB, 4 CMYK.
std::string jpeg_bytes(int width, int height, int components,
                       const std::vector<std::uint8_t>& samples, bool progressive = false);

}  // namespace sgs::test
