// Pictures in linear floating point: RGB, and RGB with alpha.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>
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

// Rectangles and words drawn into a picture.

// Characters are 3x5 dots, with a dot between two of them.
constexpr int kGlyphColumns = 3, kGlyphRows = 5;

// Width of `length` characters, in dots.
constexpr int text_dots(int length) { return length * (kGlyphColumns + 1) - 1; }

// Fills [x, x + width) x [y, y + height), cut to the picture.
void fill_rect(Image& image, int x, int y, int width, int height, const glm::vec3& colour);

// Draws `text` with its top left corner at (x, y), a dot as a square of dot_px. Letters are drawn
// as capitals; what is none of A-Z 0-9 . % - + < stays blank.
void draw_text(Image& image, int x, int y, int dot_px, std::string_view text,
               const glm::vec3& colour);

}  // namespace sgs
