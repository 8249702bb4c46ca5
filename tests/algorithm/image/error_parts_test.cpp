// Error parts of quality.h against values by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/image/quality.h"
#include "tests/algorithm/image/test_images.h"

using namespace sgs;
using test::flat_image;
using test::noise_image;

namespace {

std::vector<ErrorPart> parts_of(const std::vector<Image>& chain) {
  std::vector<const Image*> pictures;
  for (const Image& image : chain) pictures.push_back(&image);
  return error_parts(pictures);
}

}  // namespace

TEST_CASE("error parts: values by hand") {
  struct Case {
    std::string what;
    std::vector<glm::vec3> chain;  // pictures of one pixel
    std::vector<ErrorPart> parts;
  };
  const std::vector<Case> cases = {
      {"one step is all of it", {{0.5, 0.5, 0.5}, {0.5, 0.75, 0.25}}, {{1, 1}}},
      {"steps in different channels: shares are squares, 9 to 16",
       {{0, 0, 0}, {0.3F, 0, 0}, {0.3F, 0.4F, 0}},
       {{0.36, 0.36}, {0.64, 0.64}}},
      {"steps in one direction, 1 to 3: the cross term 2 x 3 of 16 is halved",
       {{0, 0, 0}, {0, 0, 0.1F}, {0, 0, 0.4F}},
       {{0.25, 1 / 16.0}, {0.75, 9 / 16.0}}},
      {"a step that takes back half of the one before",
       {{0, 0, 0}, {0.4F, 0, 0}, {0.2F, 0, 0}},
       {{2, 4}, {-1, 1}}},
      {"a step without a change", {{0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}}, {{0, 0}, {1, 1}}},
      {"what lies beyond 1 is not seen",
       {{0.5, 0, 0}, {1, 0, 0}, {5, -3, 0}, {5, 0.5F, 0}},
       {{0.5, 0.5}, {0, 0}, {0.5, 0.5}}},
  };
  for (const Case& c : cases) {
    std::vector<Image> chain;
    for (const glm::vec3& colour : c.chain) chain.push_back(flat_image(1, 1, colour));
    const std::vector<ErrorPart> parts = parts_of(chain);
    CAPTURE(c.what);
    REQUIRE(parts.size() == c.parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      CHECK(parts[i].share == Approx(c.parts[i].share).margin(1e-6));
      CHECK(parts[i].alone == Approx(c.parts[i].alone).margin(1e-6));
    }
  }
}

TEST_CASE("error parts: over all pixels, and the shares add up to 1") {
  // A step that moves 3 of 4 pixels by d and one that moves the fourth by 2 d: squares 3 to 4.
  Image first = flat_image(4, 1, glm::vec3(0.5F)), second = first;
  for (int x = 0; x < 3; ++x) second.at(x, 0).y += 0.125F;
  Image third = second;
  third.at(3, 0).z += 0.25F;
  const std::vector<ErrorPart> by_pixel = parts_of({first, second, third});
  CHECK(by_pixel[0].share == Approx(3 / 7.0));
  CHECK(by_pixel[1].share == Approx(4 / 7.0));

  std::vector<Image> chain;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    chain.push_back(noise_image(20, 10, -0.2, 1.2, seed));
  }
  double sum = 0;
  for (const ErrorPart& part : parts_of(chain)) sum += part.share;
  CHECK(sum == Approx(1).epsilon(1e-12));
}

TEST_CASE("error parts: no share of nothing, NaN is not hidden, sizes must agree") {
  const Image a = noise_image(4, 3, 0, 1, 1), b = noise_image(4, 3, 0, 1, 2);
  for (const ErrorPart& part : parts_of({a, a, a})) CHECK(std::isnan(part.share));
  Image nan = b;
  nan.at(2, 2).x = NAN;
  for (const ErrorPart& part : parts_of({a, b, nan})) CHECK(std::isnan(part.share));
  CHECK_THROWS_AS(parts_of({a, b, noise_image(3, 4, 0, 1, 1)}), InputError);
}
