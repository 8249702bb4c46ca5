// Reading of image_formats.h with libwebp.
#include <fmt/format.h>
#include <webp/decode.h>

#include <cstdint>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

const std::uint8_t* data_of(const std::string& bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

// bytes: the beginning of the file or all of it.
ImageHeader webp_header(const std::string& path, const std::string& bytes,
                        std::uint64_t file_bytes) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(data_of(bytes), bytes.size(), &features) != VP8_STATUS_OK) {
    throw InputError(path + ": damaged or cut off, expected a WebP image");
  }
  if (features.has_animation != 0) {
    throw InputError(path + ": got an animation, expected a WebP image that stands still");
  }
  // A picture of one colour takes next to nothing; beyond that a longer promise is a damaged
  // header.
  constexpr std::uint64_t kFreePixels = 1 << 24, kMostPixelsByte = 8 * 1032;
  const auto pixels = static_cast<std::uint64_t>(features.width) * features.height;
  if (pixels > kFreePixels + kMostPixelsByte * file_bytes) {
    throw InputError(fmt::format("{}: got {} bytes, expected {}x{} pixels", path, file_bytes,
                                 features.width, features.height));
  }
  return {features.width, features.height, features.has_alpha != 0};
}

}  // namespace

RgbaSamples decode_webp(const std::string& origin, const std::string& bytes) {
  const ImageHeader header = webp_header(origin, bytes, bytes.size());
  RgbaSamples samples{header.width, header.height, {}};
  samples.rgba.resize(std::size_t{4} * header.width * header.height);
  if (WebPDecodeRGBAInto(data_of(bytes), bytes.size(), samples.rgba.data(), samples.rgba.size(),
                         4 * header.width) == nullptr) {
    throw InputError(origin + ": damaged or cut off, expected a WebP image");
  }
  return samples;
}

RgbaImage read_webp(const std::string& path) {
  const InputFile file(path);
  const RgbaSamples samples = decode_webp(path, file.text_from(0, file.size_bytes()));
  RgbaImage image(samples.width, samples.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* p = samples.pixel(i);
    const float alpha = p[3] / 255.0f;
    image.pixels[i] = glm::vec4(glm::vec3(p[0], p[1], p[2]) / 255.0f * alpha, alpha);
  }
  return image;
}

ImageHeader read_webp_header(const std::string& path) {
  constexpr std::uint64_t kHeaderBytes = 1 << 12;
  const InputFile file(path);
  return webp_header(path, file.text_from(0, kHeaderBytes), file.size_bytes());
}

}  // namespace sgs
