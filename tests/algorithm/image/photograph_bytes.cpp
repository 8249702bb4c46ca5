// The libraries' encoders behind photograph_bytes.h.
#include "tests/algorithm/image/photograph_bytes.h"

#include <tiffio.h>
#include <unistd.h>
#include <webp/encode.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sgs::test {

std::string webp_bytes(int width, int height, const std::vector<std::uint8_t>& rgba) {
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &bytes);
  std::string out(reinterpret_cast<char*>(bytes), size);
  WebPFree(bytes);
  return out;
}

std::string tiff_bytes(int width, int height, const std::vector<std::uint8_t>& rgba,
                       const TiffKind& kind) {
  // libtiff writes where it can seek.
  std::string path = (std::filesystem::temp_directory_path() / "sgs-tiff-XXXXXX").string();
  ::close(::mkstemp(path.data()));
  TIFF* tiff = TIFFOpen(path.c_str(), kind.big_endian ? "wb" : "wl");
  const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 4);
  TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &alpha);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, kind.orientation);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION,
               kind.deflated ? COMPRESSION_ADOBE_DEFLATE : COMPRESSION_NONE);
  const std::size_t row_samples = 4 * static_cast<std::size_t>(width);
  for (int y = 0; y < height; ++y) {
    std::vector<std::uint16_t> wide(row_samples);
    std::vector<std::uint8_t> row(
        rgba.begin() + static_cast<std::ptrdiff_t>(y * row_samples),
        rgba.begin() + static_cast<std::ptrdiff_t>((y + 1) * row_samples));
    for (std::size_t i = 0; i < row_samples; ++i)
      wide[i] = static_cast<std::uint16_t>(257 * row[i]);
    void* samples = kind.bits == 16 ? static_cast<void*>(wide.data()) : row.data();
    TIFFWriteScanline(tiff, samples, static_cast<std::uint32_t>(y), 0);
  }
  TIFFClose(tiff);
  std::ifstream file(path, std::ios::binary);
  std::string out{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  return out;
}

}  // namespace sgs::test
