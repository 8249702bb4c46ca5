// error_map.h: the scale against OKLab, the picture and its legend.
#include "algorithm/image/error_map.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "algorithm/files/input_error.h"
#include "tests/algorithm/image/test_images.h"

using namespace sgs;
using test::flat_image;
using test::noise_image;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const glm::vec3 kBlack(0);

// An sRGB colour in OKLab (Ottosson 2020): lightness, green to red, blue to yellow.
glm::dvec3 oklab(const glm::vec3& srgb) {
  const auto linear = [](double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double r = linear(srgb.x), g = linear(srgb.y), b = linear(srgb.z);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double distance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

// The map of a picture whose one pixel errs.
Image map_of(float error, int width, int height, const std::string& caption) {
  const Image a = flat_image(width, height, glm::vec3(0));
  Image b = a;
  b.at(width / 2, height / 2).y = error;
  return error_map(a, b, {caption});
}

Image cut(const Image& image, int x0, int y0, int width, int height) {
  Image part(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) part.at(x, y) = image.at(x0 + x, y0 + y);
  }
  return part;
}

}  // namespace

TEST_CASE("error map: black up to the rounding of 8 bits, the ends of the scale beyond 1") {
  struct Case {
    double error;
    glm::vec3 colour;
  };
  const glm::vec3 least(0.17F, 0.10F, 0.50F), most(0.99F, 1.00F, 0.45F);
  const std::vector<Case> cases = {{0, kBlack}, {1e-9, kBlack}, {0.5 / 255, kBlack}, {0.002, least},
                                   {1, most},   {50, most},     {kInfinity, most}};
  for (const auto& [error, colour] : cases) {
    CAPTURE(error);
    for (int c = 0; c < 3; ++c) CHECK(error_colour(error)[c] == Approx(colour[c]).margin(1e-5));
  }
  CHECK(distance(oklab(error_colour(1.0 / 255)), oklab(kBlack)) > 0.3);
}

TEST_CASE("error map: equal factors of error look equally far apart, and brighter") {
  constexpr int kSteps = 60;
  const double factor = std::pow(1 / kLeastShownError, 1.0 / kSteps);
  double error = kLeastShownError, smallest = kInfinity, largest = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double next = error * factor * (1 + 1e-12);
    const glm::dvec3 from = oklab(error_colour(error)), to = oklab(error_colour(next));
    CAPTURE(error);
    CHECK(to.x > from.x);
    smallest = std::min(smallest, distance(from, to));
    largest = std::max(largest, distance(from, to));
    error = next;
  }
  CHECK(largest < 1.15 * smallest);
}

TEST_CASE("error map: the largest channel error of each pixel, clamped, stands at its place") {
  const Image a = noise_image(50, 300, -0.3, 1.3, 1), b = noise_image(50, 300, -0.3, 1.3, 2);
  const Image map = error_map(a, b, {"ERROR"});
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      double error = 0;
      for (int c = 0; c < 3; ++c) {
        const double va = std::clamp(a.at(x, y)[c], 0.0F, 1.0F);
        const double vb = std::clamp(b.at(x, y)[c], 0.0F, 1.0F);
        error = std::max(error, std::abs(va - vb));
      }
      REQUIRE(map.at(x, y) == error_colour(error));
    }
  }
  Image c = a, d = a;
  c.at(3, 4) = glm::vec3(1, 2, 3);
  d.at(3, 4) = glm::vec3(7, 1, 1);  // all shown as 1
  c.at(5, 6).x = d.at(5, 6).x = NAN;
  c.at(7, 8).x = NAN;
  const Image special = error_map(c, d, {"ERROR"});
  CHECK(special.at(3, 4) == kBlack);
  CHECK(special.at(5, 6) == kBlack);
  CHECK(special.at(7, 8) == error_colour(kInfinity));
}

TEST_CASE("error map: the legend's size") {
  struct Case {
    int width, height, map_width, map_height;
  };
  // A dot is 2 px or a 180th of the shorter side; text is 12 characters of 4 dots and a margin of 4
  // on either side. Too low pictures get the legend's height: 2 lines of 8, a space, a bar of 80,
  // one line, margins.
  const std::vector<Case> cases = {{640, 360, 640 + 110, 360},
                                   {1280, 720, 1280 + 220, 720},
                                   {1, 1, 1 + 110, 240},
                                   {545, 980, 545 + 165, 980},
                                   {3840, 20, 3840 + 110, 240}};
  for (const Case& c : cases) {
    const Image map = map_of(0, c.width, c.height, "ERROR");
    CAPTURE(c.width, c.height);
    CHECK(map.width == c.map_width);
    CHECK(map.height == c.map_height);
  }
  CHECK(map_of(0, 640, 360, "MISORDERED BLENDS").width == 640 + 2 * (17 * 4 - 1 + 8));
}

TEST_CASE("error map: the legend shows caption, largest error and one scale for all pictures") {
  constexpr int kWidth = 64, kHeight = 300;
  const auto legend = [&](float error, const char* caption, int y0, int height) {
    const Image map = map_of(error, kWidth, kHeight, caption);
    return cut(map, kWidth, y0, map.width - kWidth, height).pixels;
  };
  // Lines of 16 px below a margin of 8 px: caption, largest error, then the scale.
  CHECK(legend(0, "A", 8, 16) != legend(0, "B", 8, 16));
  CHECK(legend(0.25F, "A", 24, 16) != legend(0.5F, "A", 24, 16));
  CHECK(legend(0.25F, "A", 24, 16) == legend(0.25F, "B", 24, 16));
  CHECK(legend(0.25F, "A", 40, 260) == legend(0.5F, "B", 40, 260));

  // Down the middle of the bar: every colour from 1 to the least, then black.
  const Image map = map_of(0.25F, kWidth, kHeight, "A");
  std::vector<glm::vec3> bar;
  for (int y = 56; y < kHeight; ++y) bar.push_back(map.at(kWidth + 16, y));
  const auto black = std::find(bar.begin(), bar.end(), kBlack);
  REQUIRE(black - bar.begin() >= 160);
  CHECK(distance(oklab(bar.front()), oklab(error_colour(1))) < 0.01);
  CHECK(distance(oklab(*(black - 1)), oklab(error_colour(kLeastShownError))) < 0.01);
  CHECK(std::is_sorted(bar.begin(), black, [](const glm::vec3& a, const glm::vec3& b) {
    return oklab(a).x > oklab(b).x;
  }));
  CHECK(std::count(bar.begin(), bar.end(), kBlack) == 16);
}

TEST_CASE("error map: refuses pictures of different or no size") {
  const Image a = flat_image(4, 2, glm::vec3(0)), b = flat_image(2, 4, glm::vec3(0)), none;
  CHECK_THROWS_AS(error_map(a, b, {}), InputError);
  CHECK_THROWS_AS(error_map(none, none, {}), InputError);
}
