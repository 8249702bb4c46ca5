// Formats of the frame buffer.
#include "algorithm/memory/frame_buffer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "algorithm/files/input_error.h"
#include "modules/datapath/lane_steps.h"

namespace sgs {
namespace {

int level_of(float value) {
  std::byte out[3];
  encode_pixel(FrameFormat::kRgb8, {value, 0, 0}, out);
  return std::to_integer<int>(out[0]);
}

TEST_CASE("frame buffer: eight bits are clamped and rounded to nearest") {
  CHECK(level_of(0) == 0);
  CHECK(level_of(1) == 255);
  CHECK(level_of(-0.5F) == 0);
  CHECK(level_of(7) == 255);
  CHECK(level_of(0.5F) == 128);    // 127.5 goes up
  CHECK(level_of(0.00195F) == 0);  // 0.497
  CHECK(level_of(0.00197F) == 1);  // 0.502
  CHECK(level_of(std::numeric_limits<float>::infinity()) == 255);
}

TEST_CASE("frame buffer: floats come back to the bit, whatever they are") {
  Image image(3, 2);
  const float values[] = {0, -0.0F, 1e-45F, 3.4e38F, -7, 0.1F};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {values[i], values[(i + 1) % 6], values[(i + 2) % 6]};
  }
  const std::vector<std::byte> bytes = encode_frame(FrameFormat::kRgb32f, image);
  CHECK(bytes.size() == 3 * 2 * 12);
  const Image back = decode_frame(FrameFormat::kRgb32f, 3, 2, bytes);
  CHECK(std::memcmp(back.pixels.data(), image.pixels.data(), 6 * sizeof(glm::vec3)) == 0);
}

TEST_CASE("frame buffer: rows from the top, red first, no padding") {
  Image image(2, 2);
  image.pixels = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const unsigned char expected[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  const std::vector<std::byte> bytes = encode_frame(FrameFormat::kRgb8, image);
  REQUIRE(bytes.size() == sizeof expected);
  CHECK(std::memcmp(bytes.data(), expected, sizeof expected) == 0);
  const Image back = decode_frame(FrameFormat::kRgb8, 2, 2, bytes);
  CHECK(back.pixels == image.pixels);
}

TEST_CASE("frame buffer: bytes that are not a frame are refused") {
  CHECK_THROWS_AS(decode_frame(FrameFormat::kRgb8, 2, 2, std::vector<std::byte>(11)), InputError);
  CHECK_THROWS_AS(decode_frame(FrameFormat::kRgb32f, 2, 2, std::vector<std::byte>(12)), InputError);
}

}  // namespace
}  // namespace sgs
