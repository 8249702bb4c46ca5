// WebP and TIFF photographs: image_formats.h and image_io.h.
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "tests/algorithm/image/photograph_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;

namespace {

constexpr int kWidth = 13, kHeight = 7;

// Opaque above, half transparent below.
std::vector<std::uint8_t> picture() {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      rgba.insert(rgba.end(), {static_cast<std::uint8_t>(11 * x), static_cast<std::uint8_t>(29 * y),
                               200, static_cast<std::uint8_t>(y < 4 ? 255 : 102)});
    }
  }
  return rgba;
}

std::vector<std::string> kinds() {
  const auto rgba = picture();
  return {webp_bytes(kWidth, kHeight, rgba), tiff_bytes(kWidth, kHeight, rgba),
          tiff_bytes(kWidth, kHeight, rgba, {16, false, true, 1}),
          tiff_bytes(kWidth, kHeight, rgba, {8, true, false, 1})};
}

}  // namespace

TEST_CASE("photographs: WebP and TIFF of 8 and 16 bits, colours times alpha, the top row first") {
  const ScratchFolder scratch;
  for (const std::string& bytes : kinds()) {
    const std::string path = scratch.write("a.jpg", bytes);  // the first bytes say what it is
    const ImageHeader header = read_photograph_header(path);
    CHECK(header.width == kWidth);
    CHECK(header.height == kHeight);
    CHECK(header.has_alpha);
    const RgbaImage image = read_photograph(path);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double alpha = y < 4 ? 1 : 0.4;
        const glm::vec4& p = image.at(x, y);
        CHECK(255 * p.x == Approx(alpha * 11 * x).margin(0.6));
        CHECK(255 * p.y == Approx(alpha * 29 * y).margin(0.6));
        CHECK(255 * p.z == Approx(alpha * 200).margin(0.6));
        CHECK(p.w == Approx(alpha).margin(1e-6));
      }
    }
  }
}

TEST_CASE(
    "photographs refuse: WebP and TIFF cut off anywhere, other orientations, empty promises") {
  const ScratchFolder scratch;
  for (const std::string& bytes : kinds()) {
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40) {
      const std::string path = scratch.write("a.tif", bytes.substr(0, size));
      CHECK_THAT(input_error_of([&] { read_photograph(path); }), Contains(path + ": "));
    }
  }
  const std::string turned =
      scratch.write("t.tif", tiff_bytes(kWidth, kHeight, picture(), {8, false, true, 6}));
  CHECK_THAT(input_error_of([&] { read_photograph_header(turned); }),
             Contains("t.tif: got orientation 6, expected 1"));
  std::string vast = webp_bytes(kWidth, kHeight, picture());
  vast.replace(21, 4, std::string("\xff\xff\xff\x1f", 4));  // 14 bits for each side
  CHECK_THAT(input_error_of([&] { read_photograph_header(scratch.write("v.webp", vast)); }),
             Contains("v.webp: got ") && Contains("expected 16384x16384 pixels"));
  std::string large = tiff_bytes(kWidth, kHeight, picture());
  for (std::size_t at = 0; at + 12 <= large.size(); ++at) {  // the entry of its width
    if (large.compare(at, 4, std::string("\x00\x01\x03\x00", 4)) != 0 &&
        large.compare(at, 4, std::string("\x00\x01\x04\x00", 4)) != 0) {
      continue;
    }
    large[at + 2] = 4;
    large.replace(at + 8, 4, std::string("\xff\xff\xff\x7f", 4));
    break;
  }
  CHECK_THAT(input_error_of([&] { read_photograph_header(scratch.write("l.tif", large)); }),
             Contains("l.tif: got ") && Contains("expected 2147483647x7 pixels"));
}
