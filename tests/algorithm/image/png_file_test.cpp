// image_formats.h: rounding, and the kinds of PNG that others write.
#include <png.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

// What a file states beside its pixels.
using Say = std::function<void(png_structp png, png_infop info)>;

// Writes samples as libpng's full interface takes them; big-endian for 16 bits.
void write_raw_png(const std::string& path, int width, int height, int bits, int kind,
                   std::vector<std::uint8_t> samples, bool interlaced = false,
                   const Say& say = {}) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  REQUIRE(file != nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               kind, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind == PNG_COLOR_TYPE_PALETTE) {
    const png_color palette[2] = {{255, 0, 51}, {0, 102, 0}};
    png_set_PLTE(png, info, palette, 2);
  }
  if (say) say(png, info);
  const std::size_t row_bytes = samples.size() / static_cast<std::size_t>(height);
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y)
    rows.push_back(&samples[static_cast<std::size_t>(y) * row_bytes]);
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

void check_colour(const glm::vec3& got, double red, double green, double blue) {
  CHECK(got.x == Approx(red).margin(1e-6));
  CHECK(got.y == Approx(green).margin(1e-6));
  CHECK(got.z == Approx(blue).margin(1e-6));
}

}  // namespace

TEST_CASE("png: values are clamped, rounded, and NaN is black") {
  const test::ScratchFolder scratch;
  const float infinity = std::numeric_limits<float>::infinity();
  Image image(4, 1);
  image.at(0, 0) = {-1.0f, 2.0f, NAN};
  image.at(1, 0) = {infinity, -infinity, 0.0f};
  // 100.49 and 100.51 of 255; just below one.
  image.at(2, 0) = {100.49f / 255.0f, 100.51f / 255.0f, 0.9999f};
  image.at(3, 0) = {0.0019f, 0.0020f, 1.0f};
  write_image(scratch.path("a.png"), image);
  const Image back = read_png(scratch.path("a.png"));
  check_colour(back.at(0, 0), 0, 1, 0);
  check_colour(back.at(1, 0), 1, 0, 0);
  check_colour(back.at(2, 0), 100.0 / 255, 101.0 / 255, 1);
  check_colour(back.at(3, 0), 0, 1.0 / 255, 1);
}

TEST_CASE("png: transparent pixels lie over the background") {
  const test::ScratchFolder scratch;
  write_raw_png(scratch.path("a.png"), 3, 1, 8, PNG_COLOR_TYPE_RGBA,
                {255, 0, 51, 255, 255, 0, 51, 0, 255, 0, 51, 51});
  const Image black = read_png(scratch.path("a.png"));
  check_colour(black.at(0, 0), 1, 0, 0.2);
  check_colour(black.at(1, 0), 0, 0, 0);
  check_colour(black.at(2, 0), 0.2, 0, 0.04);
  const Image white = read_png(scratch.path("a.png"), glm::vec3(1));
  check_colour(white.at(0, 0), 1, 0, 0.2);
  check_colour(white.at(1, 0), 1, 1, 1);
  check_colour(white.at(2, 0), 1, 0.8, 0.84);
}

TEST_CASE("png: alpha is kept beside colour times alpha, and the header tells of it") {
  const test::ScratchFolder scratch;
  const std::string path = scratch.path("a.png");
  write_raw_png(path, 3, 1, 8, PNG_COLOR_TYPE_RGBA,
                {255, 0, 51, 255, 255, 9, 51, 0, 255, 0, 51, 51});
  const RgbaImage image = read_png_rgba(path);
  CHECK(image.at(0, 0) == glm::vec4(1, 0, 0.2f, 1));
  CHECK(image.at(1, 0) == glm::vec4(0));
  CHECK(image.at(2, 0).x == Approx(0.2));
  CHECK(image.at(2, 0).z == Approx(0.04));
  CHECK(image.at(2, 0).w == Approx(0.2));
  CHECK(read_png_header(path).has_alpha);
  CHECK(read_png_header(path).width == 3);
  CHECK(read_png_header(path).height == 1);
  write_raw_png(path, 1, 1, 16, PNG_COLOR_TYPE_RGBA, {0xff, 0xff, 0x33, 0x33, 0, 0, 0x33, 0x33});
  CHECK(read_png_rgba(path).at(0, 0).x == Approx(0.2));
  CHECK(read_png_rgba(path).at(0, 0).y == Approx(0.04));
  CHECK(read_png_rgba(path).at(0, 0).w == Approx(0.2));
  write_raw_png(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {51, 255, 51, 0});
  CHECK(read_png_rgba(path).at(0, 0) == glm::vec4(0.2f, 0.2f, 0.2f, 1));
  CHECK(read_png_rgba(path).at(1, 0) == glm::vec4(0));
  CHECK(read_png_header(path).has_alpha);
  write_raw_png(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {51, 204});
  CHECK_FALSE(read_png_header(path).has_alpha);
}

TEST_CASE("png: a header longer than usual is read to its end") {
  const test::ScratchFolder scratch;
  write_raw_png(scratch.path("a.png"), 2, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3, 4, 5, 6});
  const std::string whole = test::bytes_of(scratch.path("a.png"));
  constexpr std::size_t kFirstChunkEnd = 33;
  // An ancillary chunk that nobody knows, 200,000 bytes long; its checksum is not looked at.
  const std::string chunk =
      std::string("\0\x03\x0d\x40", 4) + "prVt" + std::string(200000, 'x') + std::string(4, '\0');
  const std::string path = scratch.write(
      "b.png", whole.substr(0, kFirstChunkEnd) + chunk + whole.substr(kFirstChunkEnd));
  CHECK(read_png_header(path).width == 2);
  CHECK_FALSE(read_png_header(path).has_alpha);
  CHECK(read_png_rgba(path).at(1, 0).z * 255 == Approx(6));
}

TEST_CASE("png: values are those stored, whatever the file says of gamma and colours") {
  const test::ScratchFolder scratch;
  const std::string path = scratch.path("a.png");
  const auto gamma = [](png_fixed_point exponent) {
    return [exponent](png_structp png, png_infop info) { png_set_gAMA_fixed(png, info, exponent); };
  };
  const auto wide = [](png_structp png, png_infop info) {  // BT.2020's primaries
    png_set_cHRM_fixed(png, info, 31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600);
  };
  const std::vector<std::pair<const char*, Say>> says = {
      {"nothing", {}},
      {"gamma 1", gamma(100'000)},
      {"gamma 1/2", gamma(50'000)},
      {"gamma 1/2.2", gamma(45'455)},
      {"primaries", wide},
      {"gamma 1 and primaries",
       [&](png_structp png, png_infop info) {
         gamma(100'000)(png, info);
         wide(png, info);
       }},
      {"sRGB", [](png_structp png, png_infop info) {
         png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
       }}};
  for (const auto& [said, say] : says) {
    INFO(said);
    for (const int bits : {8, 16}) {
      std::vector<std::uint8_t> samples;
      for (const int value : {51, 102, 204, 255, 255, 51, 102, 51}) {
        samples.insert(samples.end(), static_cast<std::size_t>(bits) / 8,
                       static_cast<std::uint8_t>(value));
      }
      write_raw_png(path, 2, 1, bits, PNG_COLOR_TYPE_RGBA, samples, false, say);
      const RgbaImage image = read_png_rgba(path);
      CHECK(image.at(0, 0) == glm::vec4(51.0f / 255, 102.0f / 255, 204.0f / 255, 1));
      CHECK(image.at(1, 0).x == Approx(0.2));
      CHECK(image.at(1, 0).y == Approx(0.04));
      CHECK(image.at(1, 0).z == Approx(0.08));
    }
    write_raw_png(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {51, 204}, false, say);
    check_colour(read_png(path).at(0, 0), 0.2, 0.2, 0.2);
    write_raw_png(path, 2, 1, 1, PNG_COLOR_TYPE_PALETTE, {0x40}, false, say);
    check_colour(read_png(path).at(1, 0), 0, 0.4, 0);
  }
}

TEST_CASE("png: grey, palette, 16 bits, interlaced") {
  const test::ScratchFolder scratch;
  const std::string path = scratch.path("a.png");
  write_raw_png(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {51, 204});
  check_colour(read_png(path).at(0, 0), 0.2, 0.2, 0.2);
  check_colour(read_png(path).at(1, 0), 0.8, 0.8, 0.8);
  write_raw_png(path, 2, 1, 1, PNG_COLOR_TYPE_PALETTE, {0x40});  // entries 0 and 1
  check_colour(read_png(path).at(0, 0), 1, 0, 0.2);
  check_colour(read_png(path).at(1, 0), 0, 0.4, 0);
  write_raw_png(path, 1, 1, 16, PNG_COLOR_TYPE_RGB, {0x33, 0x33, 0xff, 0xff, 0x00, 0x00});
  check_colour(read_png(path).at(0, 0), 0.2, 1, 0);
  std::vector<std::uint8_t> ramp;
  for (int i = 0; i < 9 * 9 * 3; ++i) ramp.push_back(static_cast<std::uint8_t>(i));
  write_raw_png(path, 9, 9, 8, PNG_COLOR_TYPE_RGB, ramp, true);
  const Image image = read_png(path);
  check_colour(image.at(4, 8), (8 * 9 + 4) * 3 / 255.0, ((8 * 9 + 4) * 3 + 1) / 255.0,
               ((8 * 9 + 4) * 3 + 2) / 255.0);
}

TEST_CASE("png refuses: other files, and sizes that the file cannot hold") {
  const test::ScratchFolder scratch;
  for (const char* bytes : {"", "x", "\x89PNG", "P6\n1 1\n255\nabc"}) {
    const std::string path = scratch.write("a.png", bytes);
    CHECK_THAT(test::input_error_of([&] { read_png(path); }), Contains("expected a PNG image"));
  }
  write_raw_png(scratch.path("b.png"), 1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3});
  std::string forged = test::bytes_of(scratch.path("b.png"));
  // Width and height of the IHDR chunk, and its checksum made right again.
  forged.replace(16, 8, std::string("\x00\x0f\x42\x40\x00\x0f\x42\x40", 8));
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<std::uint8_t>(forged[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  crc = ~crc;
  for (int i = 0; i < 4; ++i) forged[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
  const std::string path = scratch.write("c.png", forged);
  CHECK_THAT(test::input_error_of([&] { read_png(path); }),
             Contains("expected 1000000x1000000 pixels"));
}
