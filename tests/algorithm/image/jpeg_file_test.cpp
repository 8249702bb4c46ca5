// image_formats.h and image_io.h: what is read, and what is refused.
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "tests/algorithm/image/jpeg_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

// A smooth colour picture, which JPEG keeps within a few steps of 255.
std::vector<std::uint8_t> ramp(int width, int height) {
  std::vector<std::uint8_t> samples;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      samples.insert(samples.end(), {static_cast<std::uint8_t>(40 + 4 * x),
                                     static_cast<std::uint8_t>(30 + 5 * y), 90});
    }
  }
  return samples;
}

}  // namespace

TEST_CASE("jpeg: colour, baseline and progressive, rows from the top") {
  const test::ScratchFolder scratch;
  for (const bool progressive : {false, true}) {
    const std::string path =
        scratch.write("a.jpg", test::jpeg_bytes(40, 32, 3, ramp(40, 32), progressive));
    const RgbaImage image = read_jpeg(path);
    REQUIRE(image.width == 40);
    REQUIRE(image.height == 32);
    for (int y = 1; y < 32; y += 5) {
      for (int x = 1; x < 40; x += 5) {
        CHECK(image.at(x, y).x * 255 == Approx(40 + 4 * x).margin(6));
        CHECK(image.at(x, y).y * 255 == Approx(30 + 5 * y).margin(6));
        CHECK(image.at(x, y).z * 255 == Approx(90).margin(6));
        CHECK(image.at(x, y).w == 1.0f);
      }
    }
    const ImageHeader header = read_photograph_header(path);
    CHECK(header.width == 40);
    CHECK(header.height == 32);
    CHECK_FALSE(header.has_alpha);
  }
}

TEST_CASE("jpeg: grey is all three channels") {
  const test::ScratchFolder scratch;
  const std::vector<std::uint8_t> grey(16 * 8, 51);
  const RgbaImage image = read_jpeg(scratch.write("a.jpg", test::jpeg_bytes(16, 8, 1, grey)));
  CHECK(image.at(3, 4).x == Approx(0.2).margin(0.004));
  CHECK(image.at(3, 4).y == image.at(3, 4).x);
  CHECK(image.at(3, 4).z == image.at(3, 4).x);
}

TEST_CASE("jpeg: cut anywhere it is refused by name") {
  const test::ScratchFolder scratch;
  for (const bool progressive : {false, true}) {
    const std::string whole = test::jpeg_bytes(40, 32, 3, ramp(40, 32), progressive);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::string path = scratch.write("cut.jpg", whole.substr(0, size));
      INFO(size);
      CHECK_THAT(test::input_error_of([&] { read_jpeg(path); }), Contains("cut.jpg: "));
    }
  }
}

TEST_CASE("jpeg: with any byte changed it is read or refused by name") {
  const test::ScratchFolder scratch;
  for (const bool progressive : {false, true}) {
    const std::string whole = test::jpeg_bytes(40, 32, 3, ramp(40, 32), progressive);
    std::size_t refused = 0;
    for (std::size_t at = 2; at < whole.size(); ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0xff : 0x11));
      const std::string path = scratch.write("a.jpg", bytes);
      try {
        const RgbaImage image = read_jpeg(path);
        CHECK(image.pixels.size() > 0);
      } catch (const InputError& error) {
        ++refused;
        CHECK_THAT(error.what(), Contains("a.jpg: "));
      }
    }
    CHECK(refused > 10);
  }
}

TEST_CASE("jpeg: a header longer than usual is read to its end") {
  const test::ScratchFolder scratch;
  const std::string whole = test::jpeg_bytes(40, 32, 3, ramp(40, 32));
  std::string segments;  // as a camera's preview: application data of 64 KiB
  for (int i = 0; i < 3; ++i)
    segments += std::string("\xff\xe2\xff\xff", 4) + std::string(65533, 'x');
  const std::string path = scratch.write("a.jpg", whole.substr(0, 2) + segments + whole.substr(2));
  CHECK(read_jpeg_header(path).width == 40);
  CHECK(read_jpeg(path).pixels == read_jpeg(scratch.write("b.jpg", whole)).pixels);
}

TEST_CASE("jpeg refuses: four components, sizes that the file cannot hold, other files") {
  const test::ScratchFolder scratch;
  const std::vector<std::uint8_t> cmyk(16 * 8 * 4, 9);
  const std::string four = scratch.write("four.jpg", test::jpeg_bytes(16, 8, 4, cmyk));
  CHECK_THAT(test::input_error_of([&] { read_jpeg(four); }), Contains("4 colour components"));
  CHECK_THAT(test::input_error_of([&] { read_jpeg_header(four); }),
             Contains("4 colour components"));
  std::string forged = test::jpeg_bytes(16, 8, 3, std::vector<std::uint8_t>(16 * 8 * 3, 9));
  const std::size_t frame = forged.find(std::string("\xff\xc0", 2));  // then 3 bytes, height, width
  REQUIRE(frame != std::string::npos);
  forged.replace(frame + 5, 4, "\xff\x00\xff\x00", 4);
  const std::string large = scratch.write("large.jpg", forged);
  for (const auto& read : {+[](const std::string& path) { read_jpeg(path); },
                           +[](const std::string& path) { read_jpeg_header(path); }}) {
    CHECK_THAT(test::input_error_of([&] { read(large); }), Contains("expected 65280x65280 pixels"));
  }
  const std::string text = scratch.write("text.jpg", "no picture");
  CHECK_THAT(test::input_error_of([&] { read_jpeg(text); }), Contains("expected a JPEG"));
  CHECK_THAT(test::input_error_of([&] { read_photograph(text); }),
             Contains("text.jpg: neither begins as a PNG nor as a JPEG"));
}

TEST_CASE("photograph: told by the first bytes, not by the name") {
  const test::ScratchFolder scratch;
  Image image(2, 1);
  image.at(1, 0) = {1, 0, 0};
  const std::string png = scratch.write("a.jpg", encode_png(image));
  CHECK(read_photograph(png).at(1, 0) == glm::vec4(1, 0, 0, 1));
  const std::string jpeg =
      scratch.write("a.png", test::jpeg_bytes(8, 8, 1, std::vector<std::uint8_t>(64, 255)));
  CHECK(read_photograph(jpeg).at(1, 0).x == Approx(1).margin(0.01));
}
