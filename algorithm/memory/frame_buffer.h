// Formats of the frame buffer in the modelled DRAM; rows from the top, pixels without padding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

enum class FrameFormat {
  kRgb8,    // 3 B a pixel: clamped to [0, 1], times 255, rounded to nearest
  kRgb32f,  // 12 B a pixel: the floats themselves
};

constexpr std::uint32_t pixel_bytes(FrameFormat format) {
  return format == FrameFormat::kRgb8 ? 3 : 12;
}

// Writes one pixel (pixel_bytes) to out.
void encode_pixel(FrameFormat format, const glm::vec3& colour, std::byte* out);

// A whole frame as bytes, and back. decode throws InputError when the size does not fit.
std::vector<std::byte> encode_frame(FrameFormat format, const Image& image);
Image decode_frame(FrameFormat format, int width_px, int height_px,
                   const std::vector<std::byte>& bytes);

}  // namespace sgs
