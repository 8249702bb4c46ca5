// Pictures in linear floating point: RGB, and RGB with alpha.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace sgs {

// A linear RGB picture.
struct Image {
  int width = 0, height = 0;      // px
  std::vector<glm::vec3> pixels;  // [height, width] row-major, top row first

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, glm::vec3(0)) {}
  glm::vec3& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const glm::vec3& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * width + x];
  }
};

// A picture whose pixels may be transparent.
struct RgbaImage {
  int width = 0, height = 0;  // px
  // [height, width] row-major, top row first. xyz: colour times alpha, so that pixels may be
  // averaged, and laid over a background by one addition; w: alpha, 0 to 1.
  std::vector<glm::vec4> pixels;

  RgbaImage() = default;
  RgbaImage(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, glm::vec4(0)) {}
  glm::vec4& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const glm::vec4& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * width + x];
  }
};

// The picture as seen before `background`.
Image over(const RgbaImage& image, const glm::vec3& background);

// The picture at `width` x `height` px, each pixel the mean over its area. Throws InputError unless
// both are from 1 to the picture's own.
RgbaImage area_averaged(const RgbaImage& image, int width, int height);

// The size of an image, which its file states before the pixels.
struct ImageHeader {
  int width = 0, height = 0;  // px, from 1
  bool has_alpha = false;
};

}  // namespace sgs
