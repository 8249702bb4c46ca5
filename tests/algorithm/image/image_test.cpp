// image.h: backgrounds, averages over areas.
#include "algorithm/image/image.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

RgbaImage random_image(int width, int height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  RgbaImage image(width, height);
  for (glm::vec4& pixel : image.pixels) {
    const float alpha = uniform(random);
    pixel = {alpha * uniform(random), alpha * uniform(random), alpha * uniform(random), alpha};
  }
  return image;
}

// The mean over [i, i + 1) x [j, j + 1) of a `width` x `height` image, in double, from its
// definition: every source pixel by the area that it shares.
glm::dvec4 mean_over(const RgbaImage& image, int width, int height, int i, int j) {
  const auto shared = [](int at, double begin, double end) {
    return std::max(0.0, std::min(at + 1.0, end) - std::max<double>(at, begin));
  };
  const double sx = static_cast<double>(image.width) / width;
  const double sy = static_cast<double>(image.height) / height;
  glm::dvec4 sum(0);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      sum += shared(x, i * sx, (i + 1) * sx) * shared(y, j * sy, (j + 1) * sy) *
             glm::dvec4(image.at(x, y));
    }
  }
  return sum / (sx * sy);
}

}  // namespace

TEST_CASE("rgba image: averaged over areas, whole and broken factors") {
  const RgbaImage image = random_image(21, 12);
  for (const auto& [width, height] :
       {std::pair(7, 6), {21, 12}, {10, 6}, {20, 11}, {1, 1}, {3, 12}}) {
    const RgbaImage small = area_averaged(image, width, height);
    REQUIRE(small.width == width);
    REQUIRE(small.height == height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const glm::dvec4 expected = mean_over(image, width, height, x, y);
        for (int c = 0; c < 4; ++c) CHECK(small.at(x, y)[c] == Approx(expected[c]).margin(1e-6));
      }
    }
  }
  for (const auto& [width, height] : {std::pair(0, 1), {1, 0}, {22, 12}, {21, 13}}) {
    CHECK_THAT(test::input_error_of([&, w = width, h = height] { area_averaged(image, w, h); }),
               Contains("21x12 px averaged to"));
  }
}

TEST_CASE("rgba image: what is transparent has no colour to give when averaged") {
  RgbaImage image(2, 1);
  image.at(0, 0) = {1, 0.5f, 0, 1};
  const RgbaImage small = area_averaged(image, 1, 1);
  CHECK(small.at(0, 0) == glm::vec4(0.5f, 0.25f, 0, 0.5f));
  CHECK(over(small, glm::vec3(0)).at(0, 0) == glm::vec3(0.5f, 0.25f, 0));
  CHECK(over(small, glm::vec3(1, 0, 1)).at(0, 0) == glm::vec3(1, 0.25f, 0.5f));
}
