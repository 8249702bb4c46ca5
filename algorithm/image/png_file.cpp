// Reading and writing of image_formats.h with libpng's simplified interface, which reports errors
// by value: the full one leaves functions by longjmp.
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

std::uint8_t quantised(float value) {
  // A comparison that is false for NaN first, so that NaN becomes 0.
  if (!(value > 0.0f)) return 0;
  return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f));
}

std::vector<std::uint8_t> levels_of(const Image& image) {
  std::vector<std::uint8_t> levels;
  levels.reserve(3 * image.pixels.size());
  for (const glm::vec3& pixel : image.pixels) {
    levels.insert(levels.end(), {quantised(pixel.x), quantised(pixel.y), quantised(pixel.z)});
  }
  return levels;
}

// libpng's own state must be released whichever way the reader is left.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

[[noreturn]] void refuse(const std::string& path, const PngImage& png) {
  throw InputError(fmt::format("{}: {}, expected a PNG image", path, png.message));
}

void check_size(const std::string& path, const PngImage& png, std::uint64_t file_bytes) {
  // Deflate packs at most 1032 bytes into one, so a longer promise is a damaged header.
  constexpr std::uint64_t kMaxExpansion = 1032;
  const std::uint64_t pixel_count = std::uint64_t{png.width} * png.height;
  // The smallest pixel takes one bit.
  if (pixel_count / 8 > kMaxExpansion * file_bytes || png.width > INT32_MAX ||
      png.height > INT32_MAX) {
    throw InputError(fmt::format("{}: got {} bytes, expected {}x{} pixels", path, file_bytes,
                                 png.width, png.height));
  }
}

// The file less what says how its values are to be seen (gamma, primaries, profiles): libpng's
// simplified reader would convert them to sRGB, and pictures here are their values as stored. A
// file that is cut off or is no PNG stays as it is, for libpng to refuse.
std::string without_colour_space(const std::string& packed) {
  constexpr std::size_t kSignatureBytes = 8, kFrameBytes = 12;  // length, name, checksum of a chunk
  constexpr std::array<std::string_view, 7> kColourSpace = {"gAMA", "cHRM", "sRGB", "iCCP",
                                                            "cICP", "mDCV", "cLLI"};
  std::string kept = packed.substr(0, kSignatureBytes);
  std::size_t at = kept.size();
  while (packed.size() - at >= kFrameBytes) {
    std::uint64_t chunk_bytes = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      chunk_bytes = chunk_bytes << 8 | static_cast<std::uint8_t>(packed[at + i]);
    }
    chunk_bytes += kFrameBytes;
    if (chunk_bytes > packed.size() - at) break;
    const std::string_view name = std::string_view(packed).substr(at + 4, 4);
    if (std::find(kColourSpace.begin(), kColourSpace.end(), name) == kColourSpace.end()) {
      kept.append(packed, at, chunk_bytes);
    }
    at += chunk_bytes;
  }
  return kept.append(packed, at, std::string::npos);
}

}  // namespace

std::string encode_png(const Image& image) {
  const std::vector<std::uint8_t> values = levels_of(image);
  PngImage png;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, values.data(), 0, nullptr) == 0) {
    throw std::runtime_error(fmt::format("PNG of {}x{} pixels: {}", image.width, image.height,
                                         static_cast<const char*>(png.message)));
  }
  bytes.resize(size);
  return bytes;
}

bool same_png(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && levels_of(a) == levels_of(b);
}

RgbaImage read_png_rgba(const std::string& path) {
  const InputFile file(path);
  const std::string packed = without_colour_space(file.text_from(0, file.size_bytes()));
  PngImage png;
  if (png_image_begin_read_from_memory(&png, packed.data(), packed.size()) == 0) refuse(path, png);
  check_size(path, png, packed.size());
  png.format = PNG_FORMAT_RGBA;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // 16-bit files too hold display-referred values
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr) == 0) refuse(path, png);

  RgbaImage image(static_cast<int>(png.width), static_cast<int>(png.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* p = &rgba[4 * i];
    const float alpha = static_cast<float>(p[3]) / 255.0f;
    image.pixels[i] = glm::vec4(glm::vec3(p[0], p[1], p[2]) / 255.0f * alpha, alpha);
  }
  return image;
}

Image read_png(const std::string& path, const glm::vec3& background) {
  return over(read_png_rgba(path), background);
}

ImageHeader read_png_header(const std::string& path) {
  constexpr std::uint64_t kUsualHeaderBytes = 1 << 16;  // colour profiles may make it longer
  constexpr std::uint64_t kMostHeaderBytes = 1 << 26;
  const InputFile file(path);
  std::string head;  // outlives png
  PngImage png;
  const auto begins = [&](std::uint64_t most_bytes) {
    head = file.text_from(0, most_bytes);
    return png_image_begin_read_from_memory(&png, head.data(), head.size()) != 0;
  };
  if (!begins(kUsualHeaderBytes) && !begins(kMostHeaderBytes)) refuse(path, png);
  check_size(path, png, file.size_bytes());
  return {static_cast<int>(png.width), static_cast<int>(png.height),
          (png.format & PNG_FORMAT_FLAG_ALPHA) != 0};
}

}  // namespace sgs
