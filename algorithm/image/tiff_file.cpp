// Reading of image_formats.h with libtiff, the first picture of a file.
#include <fmt/format.h>
#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_formats.h"

namespace sgs {
namespace {

constexpr tmsize_t kMostAllocatedBytes = 1 << 30;

int keep_error(TIFF*, void* message, const char*, const char* format, va_list values) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, values);
  auto& kept = *static_cast<std::string*>(message);
  if (kept.empty()) kept = text;  // the first is the reason, others follow from it
  return 1;
}

int pass_over(TIFF*, void*, const char*, const char*, va_list) { return 1; }

class TiffReader {
 public:
  explicit TiffReader(const std::string& path)
      : path_(path), file_bytes_(InputFile(path).size_bytes()) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
        TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &error_);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_over, nullptr);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMostAllocatedBytes);
    tiff_.reset(TIFFOpenExt(path.c_str(), "r", options.get()));
    if (!tiff_) refuse();
  }

  ImageHeader header() {
    std::uint32_t width = 0, height = 0;
    std::uint16_t orientation = ORIENTATION_TOPLEFT, extra = 0;
    std::uint16_t* kinds = nullptr;
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &height);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_ORIENTATION, &orientation);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    if (orientation != ORIENTATION_TOPLEFT) {
      throw InputError(
          fmt::format("{}: got orientation {}, expected 1: the top row first", path_, orientation));
    }
    // As of PNG: deflate packs at most 1032 bytes into one.
    constexpr std::uint64_t kMostPixelsByte = 8 * 1032;
    if (width < 1 || height < 1 || width > INT32_MAX || height > INT32_MAX ||
        std::uint64_t{width} * height / kMostPixelsByte > file_bytes_) {
      throw InputError(fmt::format("{}: got {} bytes, expected {}x{} pixels", path_, file_bytes_,
                                   width, height));
    }
    char reason[1024] = "";
    if (TIFFRGBAImageOK(tiff_.get(), reason) == 0) {
      throw InputError(
          fmt::format("{}: {}, expected a TIFF image of 8 or 16 bits a channel", path_, reason));
    }
    return {static_cast<int>(width), static_cast<int>(height), extra > 0};
  }

  RgbaImage image() {
    const ImageHeader size = header();
    RgbaImage image(size.width, size.height);
    std::vector<std::uint32_t> raster(image.pixels.size());
    if (TIFFReadRGBAImageOriented(tiff_.get(), static_cast<std::uint32_t>(size.width),
                                  static_cast<std::uint32_t>(size.height), raster.data(),
                                  ORIENTATION_TOPLEFT, 1) == 0 ||
        !error_.empty()) {
      refuse();
    }
    for (std::size_t i = 0; i < raster.size(); ++i) {
      // libtiff gives colours times alpha.
      const std::uint32_t p = raster[i];
      image.pixels[i] = glm::vec4(TIFFGetR(p), TIFFGetG(p), TIFFGetB(p), TIFFGetA(p)) / 255.0f;
    }
    return image;
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError(
        fmt::format("{}: {}, expected a TIFF image", path_, error_.empty() ? "damaged" : error_));
  }

  std::string path_, error_;
  std::uint64_t file_bytes_;
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

}  // namespace

RgbaImage read_tiff(const std::string& path) { return TiffReader(path).image(); }

ImageHeader read_tiff_header(const std::string& path) { return TiffReader(path).header(); }

}  // namespace sgs
