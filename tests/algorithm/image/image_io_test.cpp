// image_io.h: all formats alike. What is special to one has its own test file.
#include "algorithm/image/image_io.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/algorithm/image/test_images.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

}  // namespace

TEST_CASE("image files: float formats keep every bit") {
  const test::ScratchFolder scratch;
  const std::vector<std::pair<int, int>> sizes = {{1, 1}, {1, 200}, {200, 1}, {37, 131}};
  for (const auto& [width, height] : sizes) {
    Image image = test::noise_image(width, height, -100, 100, 1);
    image.at(0, 0) = {-0.0f, std::numeric_limits<float>::infinity(), NAN};
    image.at(width - 1, height - 1).y = std::numeric_limits<float>::denorm_min();
    for (const char* name : {"a.exr", "a.pfm", "a.EXR", "a.PfM"}) {
      CAPTURE(name, width, height);
      write_image(scratch.path(name), image);
      CHECK(same_bits(read_image(scratch.path(name)), image));
    }
  }
  CHECK(scratch.file_count() == 4);  // no temporaries
}

TEST_CASE("image files: png keeps 8 bits") {
  const test::ScratchFolder scratch;
  Image image(16, 17);
  for (int i = 0; i < 16 * 17; ++i) {
    const auto value = static_cast<float>(i % 256) / 255.0f;
    image.pixels[i] = {value, 1.0f - value, 0.5f};
  }
  write_image(scratch.path("a.png"), image);
  const Image back = read_image(scratch.path("a.png"));
  REQUIRE(back.width == 16);
  REQUIRE(back.height == 17);
  for (int i = 0; i < 16 * 17; ++i) {
    CHECK(back.pixels[i].x == image.pixels[i].x);
    CHECK(back.pixels[i].y == Approx(image.pixels[i].y).margin(1e-6));
    CHECK(back.pixels[i].z == 128.0f / 255.0f);  // 127.5 is rounded up
  }
}

TEST_CASE("image files refuse: other extensions, no pixels, bad places") {
  const test::ScratchFolder scratch;
  const Image image(2, 2);
  scratch.write("file", "");
  CHECK_THAT(test::input_error_of([&] { write_image(scratch.path("a.jpg"), image); }),
             Contains("got the extension \".jpg\", expected .exr, .pfm or .png"));
  CHECK_THAT(test::input_error_of([&] { read_image(scratch.path("noextension")); }),
             Contains("got the extension \"\""));
  Image wrong(2, 2);
  wrong.pixels.pop_back();
  for (const char* name : {"a.exr", "a.pfm", "a.png"}) {
    test::input_error_of([&] { write_image(scratch.path(name), Image()); });
    test::input_error_of([&] { write_image(scratch.path(name), wrong); });
    test::input_error_of([&] { write_image(scratch.path(std::string("file/") + name), image); });
    CHECK_THAT(test::input_error_of([&] { read_image(scratch.path(name)); }), Contains(name));
  }
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("image files: cut anywhere they are refused, or the picture is whole") {
  const test::ScratchFolder scratch;
  const Image image = test::noise_image(9, 5, 0, 1, 2);
  for (const char* extension : {".exr", ".pfm", ".png"}) {
    const std::string name = scratch.path(std::string("a") + extension);
    write_image(name, image);
    const Image whole = read_image(name);
    const std::string bytes = test::bytes_of(name);
    std::size_t refused = 0;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string path = scratch.write(std::string("cut") + extension, bytes.substr(0, size));
      CAPTURE(extension, size, bytes.size());
      try {
        const Image got = read_image(path);
        REQUIRE(same_bits(got, whole));
      } catch (const InputError& error) {
        REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
        ++refused;
      }
    }
    // A PNG may lack its trailer of 12 bytes and the checksum of the data before it.
    CHECK(refused >= bytes.size() - 24);
  }
}

TEST_CASE("image files: damaged bytes are read or refused, nothing else") {
  const test::ScratchFolder scratch;
  Random random(8);
  const Image image = test::noise_image(9, 5, 0, 1, 2);
  for (const char* extension : {".exr", ".pfm", ".png"}) {
    const std::string name = scratch.path(std::string("a") + extension);
    write_image(name, image);
    const std::string bytes = test::bytes_of(name);
    for (int round = 0; round < 800; ++round) {
      std::string damaged = bytes;
      damaged[random.bits() % damaged.size()] = static_cast<char>(random.bits());
      const std::string path = scratch.write(std::string("damaged") + extension, damaged);
      try {
        const Image got = read_image(path);
        CHECK(got.pixels.size() == static_cast<std::size_t>(got.width) * got.height);
      } catch (const InputError&) {
        continue;
      }
    }
  }
}
