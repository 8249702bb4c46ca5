// A linear RGB picture in float.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace sgs {

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

}  // namespace sgs
