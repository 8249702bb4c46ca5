// libwebp.
#include "algorithm/scene_files/webp_texture.h"

#include <fmt/format.h>
#include <webp/decode.h>

#include "algorithm/files/input_error.h"

namespace sgs {

RgbaTexture read_webp(const SceneParts& parts, const std::string& name, std::uint64_t pixels) {
  // A byte of WebP stands for fewer pixels than this.
  constexpr std::uint64_t kMostPixelsOfByte = 16384;
  const std::string bytes = parts.bytes(name);
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto refuse = [&](const std::string& got, const std::string& expected) {
    throw InputError(fmt::format("{}: got {}, expected {}", parts.origin(name), got, expected));
  };
  int width = 0, height = 0;
  if (WebPGetInfo(data, bytes.size(), &width, &height) == 0) {
    refuse(fmt::format("{} bytes that are no picture", bytes.size()), "a WebP picture");
  }
  RgbaTexture texture{static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), {}};
  const std::uint64_t have = texture.width * texture.height;
  if (have < pixels || have / kMostPixelsOfByte > bytes.size()) {
    refuse(fmt::format("{} x {} px in {} bytes", width, height, bytes.size()),
           fmt::format("at least {} px, and a byte for {}", pixels, kMostPixelsOfByte));
  }
  texture.rgba.resize(4 * have);
  if (WebPDecodeRGBAInto(data, bytes.size(), texture.rgba.data(), texture.rgba.size(), 4 * width) ==
      nullptr) {
    refuse("a damaged WebP picture", "a whole one");
  }
  return texture;
}

}  // namespace sgs
