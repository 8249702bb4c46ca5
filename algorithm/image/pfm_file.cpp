// Reading and writing of image_formats.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "floats are stored as they lie in memory");

constexpr std::uint64_t kMaxHeaderBytes = 256;

struct PfmHeader {
  int channels = 3;
  std::uint64_t width = 0, height = 0;  // px
  double scale = -1;                    // negative: little-endian
  std::uint64_t body_offset_bytes = 0;
};

PfmHeader read_header(const InputFile& file) {
  // The numbers are separated by blanks; exactly one follows the scale.
  std::istringstream text(file.text_from(0, kMaxHeaderBytes));
  PfmHeader header;
  std::string magic;
  long long width = 0, height = 0;
  text >> magic >> width >> height >> header.scale;
  if (!text || (magic != "PF" && magic != "Pf") || width < 1 || height < 1 || header.scale == 0 ||
      !std::isfinite(header.scale) || !std::isspace(text.peek())) {
    throw InputError(fmt::format(
        "{}: byte 0: not a PFM header, expected PF or Pf, width, height and a scale that is not 0",
        file.path()));
  }
  header.channels = magic == "PF" ? 3 : 1;
  header.width = static_cast<std::uint64_t>(width);
  header.height = static_cast<std::uint64_t>(height);
  header.body_offset_bytes = static_cast<std::uint64_t>(text.tellg()) + 1;
  const std::uint64_t body_bytes = file.size_bytes() - header.body_offset_bytes;
  const std::uint64_t pixel_bytes = sizeof(float) * static_cast<std::uint64_t>(header.channels);
  if (header.width > INT32_MAX || header.height > INT32_MAX || body_bytes % pixel_bytes != 0 ||
      body_bytes / pixel_bytes / header.width != header.height ||
      body_bytes / pixel_bytes % header.width != 0) {
    throw InputError(fmt::format("{}: byte {}: got {} bytes, expected {}x{} pixels of {} bytes",
                                 file.path(), header.body_offset_bytes, body_bytes, width, height,
                                 pixel_bytes));
  }
  return header;
}

void swap_bytes(std::vector<float>& values) {
  for (float& value : values) {
    std::array<char, sizeof(float)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof value);
  }
}

}  // namespace

std::string encode_pfm(const Image& image) {
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const std::size_t header_bytes = bytes.size();
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * sizeof(glm::vec3);
  bytes.resize(header_bytes + row_bytes * static_cast<std::size_t>(image.height));
  char* to = bytes.data() + header_bytes;
  for (int y = image.height - 1; y >= 0; --y, to += row_bytes) {
    std::memcpy(to, &image.at(0, y), row_bytes);
  }
  return bytes;
}

Image read_pfm(const std::string& path) {
  const InputFile file(path);
  const PfmHeader header = read_header(file);
  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  std::vector<float> row(header.width * static_cast<std::uint64_t>(header.channels));
  std::uint64_t offset_bytes = header.body_offset_bytes;
  const auto factor = static_cast<float>(std::abs(header.scale));
  for (int y = image.height - 1; y >= 0; --y, offset_bytes += row.size() * sizeof(float)) {
    file.read_at(offset_bytes, row.data(), row.size() * sizeof(float));
    if (header.scale > 0) swap_bytes(row);
    for (int x = 0; x < image.width; ++x) {
      const float* values = &row[static_cast<std::size_t>(x) * header.channels];
      for (int channel = 0; channel < 3; ++channel) {
        image.at(x, y)[channel] = values[header.channels == 3 ? channel : 0] * factor;
      }
    }
  }
  return image;
}

}  // namespace sgs
