// Pixels to bytes and back.
#include "algorithm/memory/frame_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/counting.h"

namespace sgs {

void encode_pixel(FrameFormat format, const glm::vec3& colour, std::byte* out) {
  for (int channel = 0; channel < 3; ++channel) {
    if (format == FrameFormat::kRgb8) {
      out[channel] = static_cast<std::byte>(static_cast<std::uint8_t>(level_of(colour[channel])));
    } else {
      std::memcpy(out + 4 * channel, &colour[channel], 4);
    }
  }
}

std::vector<std::byte> encode_frame(FrameFormat format, const Image& image) {
  std::vector<std::byte> bytes(image.pixels.size() * pixel_bytes(format));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    encode_pixel(format, image.pixels[i], bytes.data() + i * pixel_bytes(format));
  }
  return bytes;
}

Image decode_frame(FrameFormat format, int width_px, int height_px,
                   const std::vector<std::byte>& bytes) {
  Image image(width_px, height_px);
  const std::size_t expected = image.pixels.size() * pixel_bytes(format);
  if (bytes.size() != expected) {
    throw InputError(fmt::format("frame buffer: {} bytes, expected {} for {}x{}", bytes.size(),
                                 expected, width_px, height_px));
  }
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::byte* from = bytes.data() + i * pixel_bytes(format);
    for (int channel = 0; channel < 3; ++channel) {
      if (format == FrameFormat::kRgb8) {
        image.pixels[i][channel] = static_cast<float>(std::to_integer<int>(from[channel])) / 255.0F;
      } else {
        std::memcpy(&image.pixels[i][channel], from + 4 * channel, 4);
      }
    }
  }
  return image;
}

}  // namespace sgs
