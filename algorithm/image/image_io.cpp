// The choice of the format.
#include "algorithm/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

struct Format {
  const char* extension;
  std::string (*encode)(const Image&);
  Image (*read)(const std::string&);
};

const Format& format_of(const std::string& path) {
  static const std::array<Format, 3> kFormats = {
      {{".exr", encode_exr, read_exr},
       {".pfm", encode_pfm, read_pfm},
       {".png", encode_png, [](const std::string& png) { return read_png(png); }}}};
  const std::string extension = extension_of(path);
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw InputError(
      fmt::format("{}: got the extension \"{}\", expected .exr, .pfm or .png", path, extension));
}

}  // namespace

void check_image_name(const std::string& path) { format_of(path); }

void write_image(OutputFile& to, const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height) {
    throw InputError(fmt::format("{}: got an image of {}x{} with {} pixels, expected at least one",
                                 to.path(), image.width, image.height, image.pixels.size()));
  }
  to.write(format_of(to.path()).encode(image));
}

void write_image(const std::string& path, const Image& image) {
  check_image_name(path);
  OutputFile output(path);
  write_image(output, image);
  output.commit();
}

Image read_image(const std::string& path) { return format_of(path).read(path); }

namespace {

struct PhotographFormat {
  RgbaImage (*read)(const std::string& path);
  ImageHeader (*read_header)(const std::string& path);
};

PhotographFormat photograph_format(const std::string& path) {
  const std::string head = InputFile(path).text_from(0, 12);
  const auto begins = [&](const std::string& bytes, std::size_t at = 0) {
    return head.size() >= at && head.compare(at, bytes.size(), bytes) == 0;
  };
  const std::string zero(1, '\0');
  if (begins("\x89PNG\r\n\x1a\n")) return {read_png_rgba, read_png_header};
  if (begins("\xff\xd8")) return {read_jpeg, read_jpeg_header};
  if (begins("RIFF") && begins("WEBP", 8)) return {read_webp, read_webp_header};
  for (const std::string& kind : {"*" + zero, "+" + zero}) {  // of 32-bit and 64-bit offsets
    if (begins("II" + kind) || begins("MM" + zero + kind[0])) return {read_tiff, read_tiff_header};
  }
  throw InputError(fmt::format(
      "{}: neither begins as a PNG nor as a JPEG, WebP or TIFF, expected one of them", path));
}

}  // namespace

RgbaImage read_photograph(const std::string& path) { return photograph_format(path).read(path); }

ImageHeader read_photograph_header(const std::string& path) {
  return photograph_format(path).read_header(path);
}

}  // namespace sgs
