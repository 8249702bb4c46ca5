// The choice of the format for image_io.h.
#include "algorithm/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "algorithm/image/exr_file.h"
#include "algorithm/image/pfm_file.h"
#include "algorithm/image/png_file.h"
#include "algorithm/input_error.h"

namespace sgs {
namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

[[noreturn]] void refuse_extension(const std::string& path, const std::string& extension) {
  throw InputError(
      fmt::format("{}: got the extension \"{}\", expected .exr, .pfm or .png", path, extension));
}

}  // namespace

void write_image(const std::string& path, const Image& image) {
  const std::string extension = extension_of(path);
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height) {
    throw InputError(fmt::format("{}: got an image of {}x{} with {} pixels, expected at least one",
                                 path, image.width, image.height, image.pixels.size()));
  }
  if (extension == ".exr") return write_exr(path, image);
  if (extension == ".pfm") return write_pfm(path, image);
  if (extension == ".png") return write_png(path, image);
  refuse_extension(path, extension);
}

Image read_image(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".exr") return read_exr(path);
  if (extension == ".pfm") return read_pfm(path);
  if (extension == ".png") return read_png(path);
  refuse_extension(path, extension);
}

}  // namespace sgs
