// Pictures in WebP whose pixels are numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene_files/scene_parts.h"

namespace sgs {

// A picture of 8-bit samples.
struct RgbaTexture {
  std::uint64_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // [height, width, 4]

  const std::uint8_t* pixel(std::uint64_t index) const { return &rgba[4 * index]; }
};

// Decodes a WebP picture of at least `pixels` pixels. Throws InputError.
RgbaTexture read_webp(const SceneParts& parts, const std::string& name, std::uint64_t pixels);

}  // namespace sgs
