// Reading and writing of image_formats.h with the OpenEXR library.
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <new>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

constexpr std::array<const char*, 3> kChannels = {"R", "G", "B"};
constexpr int kMaxSidePx = 65535;
constexpr int kRowsAtOnce = 64;  // memory grows with the rows that are really in the file

// Slices over `pixels`, whose first row is row `top` of the data window that begins at `left`.
Imf::FrameBuffer frame_of(glm::vec3* pixels, int left, int top, int width) {
  // Signed arithmetic: OpenEXR wants the address that pixel (0, 0) would have.
  const auto stride = static_cast<std::intptr_t>(sizeof(glm::vec3));
  const std::intptr_t shift = (static_cast<std::intptr_t>(top) * width + left) * stride;
  Imf::FrameBuffer frame;
  for (std::size_t channel = 0; channel < kChannels.size(); ++channel) {
    const auto first = reinterpret_cast<std::intptr_t>(pixels) +
                       static_cast<std::intptr_t>(channel * sizeof(float));
    frame.insert(kChannels[channel],
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first - shift), sizeof(glm::vec3),
                            sizeof(glm::vec3) * static_cast<std::size_t>(width)));
  }
  return frame;
}

void check_channels(const std::string& path, const Imf::ChannelList& channels) {
  for (const char* name : kChannels) {
    const Imf::Channel* channel = channels.findChannel(name);
    if (channel != nullptr && channel->xSampling == 1 && channel->ySampling == 1) continue;
    std::string got;
    for (auto i = channels.begin(); i != channels.end(); ++i) got += std::string(" ") + i.name();
    throw InputError(
        fmt::format("{}: got the channels{}, expected R, G and B at full resolution", path, got));
  }
}

// OpenEXR makes room for an attribute of whatever size it states. OpenEXR reports
// all other errors.
void check_attribute_sizes(const InputFile& file) {
  constexpr std::uint64_t kMagicAndVersionBytes = 8;
  constexpr std::uint64_t kMostNameBytes = 256, kSizeBytes = 4;  // a name, a type, a size
  if (file.text_from(0, 4) != "\x76\x2f\x31\x01") return;
  std::uint64_t at = kMagicAndVersionBytes;
  while (at < file.size_bytes()) {
    const std::string head = file.text_from(at, 2 * kMostNameBytes + kSizeBytes);
    const std::size_t name_end = head.find('\0');
    if (name_end == 0 || name_end == std::string::npos) return;  // 0: the header ends
    const std::size_t type_end = head.find('\0', name_end + 1);
    if (type_end == std::string::npos || type_end + kSizeBytes >= head.size()) return;
    std::uint32_t size = 0;
    std::memcpy(&size, head.data() + type_end + 1, kSizeBytes);
    at += type_end + 1 + kSizeBytes;
    if (size > file.size_bytes() - at) {
      throw InputError(fmt::format(
          "{}: byte {}: attribute {}: got {} bytes, expected at most the {} to the end",
          file.path(), at - kSizeBytes, head.substr(0, name_end), size, file.size_bytes() - at));
    }
    at += size;
  }
}

Image read_pixels(const std::string& path) {
  // Checked by OpenEXR before it allocates its tables of line offsets.
  Imf::Header::setMaxImageSize(kMaxSidePx, kMaxSidePx);
  Imf::Header::setMaxTileSize(kMaxSidePx, kMaxSidePx);
  Imf::InputFile file(path.c_str());
  check_channels(path, file.header().channels());
  const Imath::Box2i window = file.header().dataWindow();
  const int height = window.max.y - window.min.y + 1;
  Image image;
  image.width = window.max.x - window.min.x + 1;
  for (int y = 0; y < height; y += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, height - y);
    image.height = y + rows;
    image.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
    const int top = window.min.y + y;
    file.setFrameBuffer(frame_of(&image.at(0, y), window.min.x, top, image.width));
    file.readPixels(top, top + rows - 1);
  }
  return image;
}

}  // namespace

std::string encode_exr(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : kChannels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Imf::StdOSStream bytes;
  {
    Imf::OutputFile file(bytes, header);
    // OpenEXR takes a pointer to non-const for reading and for writing; here it only reads.
    file.setFrameBuffer(frame_of(const_cast<glm::vec3*>(image.pixels.data()), 0, 0, image.width));
    file.writePixels(image.height);
  }
  return bytes.str();
}

Image read_exr(const std::string& path) {
  check_attribute_sizes(InputFile(path));  // and OpenEXR would wait for the writer of a pipe
  try {
    return read_pixels(path);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}, expected an OpenEXR image", path, error.what()));
  }
}

}  // namespace sgs
