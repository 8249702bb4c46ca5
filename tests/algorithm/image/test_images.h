// Pictures for the tests of algorithm/image.
#pragma once

#include "algorithm/image/image.h"
#include "testbench/builtin/random.h"

namespace sgs::test {

// Independent values from low to high.
inline Image noise_image(int width, int height, double low, double high, std::uint64_t seed) {
  Random random(seed);
  Image image(width, height);
  for (glm::vec3& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(random.uniform(low, high));
  }
  return image;
}

inline Image flat_image(int width, int height, const glm::vec3& colour) {
  Image image(width, height);
  for (glm::vec3& pixel : image.pixels) pixel = colour;
  return image;
}

}  // namespace sgs::test
