// Pixels in fixed point beside the same sums in double: errors stay below what rounding can add up
// to, and nothing leaves its range.
#include "algorithm/splat/fixed_pixel.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "algorithm/splat/blend.h"

namespace sgs::test {
namespace {

TEST_CASE("pixels in fixed point: layers of one alpha, beside double") {
  struct Layers {
    double alpha, colour;
    int layers;
  };
  for (const auto& [alpha, colour, layers] :
       {Layers{1 / 255.0, 1, 3000}, Layers{0.01, 0.3, 900}, Layers{0.1, 3.9, 80},
        Layers{0.5, 0.001, 12}, Layers{0.99, 1, 2}}) {
    CAPTURE(alpha, colour, layers);
    const std::uint32_t opaque = in_fixed_units(static_cast<float>(alpha), kFixedLight);
    const std::uint32_t of_splat = fixed_colour(static_cast<float>(colour));
    const double taken = of_fixed_units(opaque, kFixedLight);  // what alpha's own rounding leaves
    std::uint32_t light = kFixedLight, pixel = 0;
    double exact = 1, white = 0;
    int blended = 0;
    for (; blended < layers; ++blended) {
      const FixedShare share = take_fixed_light(opaque, light);
      if (share.after < kFixedTransmittanceMin) break;
      pixel = add_fixed_colour(pixel, of_splat, share.weight);
      light = share.after;
      white += colour * taken * exact;
      exact *= 1 - taken;
    }
    CHECK(blended > 0);
    // Half a unit a layer at most, and what an error of light does to the layers behind.
    const double of_light = 0.5 * blended / kFixedLight;
    CHECK(std::abs(of_fixed_units(light, kFixedLight) - exact) <= of_light);
    CHECK(std::abs(of_fixed_units(pixel, kFixedColour) - white) <=
          0.5 * blended / kFixedColour + 0.5 / kFixedColour +
              colour * (of_light + 0.5 * blended / kFixedLight));
  }
}

TEST_CASE("pixels in fixed point: both ends") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  struct End {
    float colour;
    std::uint32_t units;
  };
  for (const auto& [colour, units] :
       {End{0, 0}, End{-1, 0}, End{std::nanf(""), 0}, End{1, kFixedColour}, End{1e-5F, 0},
        End{1 / 32768.0F, 1}, End{4, kLargestFixedColour}, End{1e30F, kLargestFixedColour},
        End{kInfinity, kLargestFixedColour}}) {
    CAPTURE(colour);
    CHECK(fixed_colour(colour) == units);
  }
  // The largest factors: nothing overflows, and a pixel stays at the largest colour.
  CHECK(fixed_product(kLargestFixedColour, kFixedLight) == kLargestFixedColour);
  CHECK(add_fixed_colour(kLargestFixedColour, kLargestFixedColour, kFixedLight) ==
        kLargestFixedColour);
  // Light of 1e-4 finishes a pixel from below, as in float.
  CHECK(of_fixed_units(kFixedTransmittanceMin, kFixedLight) >= 1e-4F);
  CHECK(of_fixed_units(kFixedTransmittanceMin - 1, kFixedLight) < 1e-4F);
  for (std::uint32_t light = 0; light <= kFixedLight; ++light) {
    const FixedShare share = take_fixed_light(in_fixed_units(0.99F, kFixedLight), light);
    REQUIRE(share.weight + share.after == light);
  }
}

TEST_CASE("blending on pixels in fixed point: near single precision, nearer than in half") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> shade(0, 1), place(-8, 12), width(1, 12);
  double of_fixed = 0, of_half = 0;
  for (int round = 0; round < 300; ++round) {
    SubtileState single = make_subtile(3, 5, 100, 100), in_half = single, fixed = single;
    for (int layer = 0; layer < 12; ++layer) {
      Splat s{};
      const float sigma = width(random);
      s.conic_a = s.conic_c = 1 / (sigma * sigma);
      s.conic_b = 0.5F * s.conic_a;
      s.x = 14 + place(random);
      s.y = 22 + place(random);
      s.opacity = shade(random);
      s.rgb = {shade(random), shade(random), 2 * shade(random)};
      blend(single, 3, 5, s);
      blend(in_half, 3, 5, square_splat(s));
      const LaneShares shares = blend_and_tell(fixed, 3, 5, SplatOnFixedPixels{square_splat(s)});
      for (int lane = 0; lane < kSubtilePixels; ++lane) {
        CHECK(fixed.transmittance[lane] <= shares.before[lane]);
      }
    }
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      of_fixed += std::pow(single.blue[lane] - fixed.blue[lane], 2);
      of_half += std::pow(single.blue[lane] - in_half.blue[lane], 2);
      const float units = fixed.blue[lane] * static_cast<float>(kFixedColour);
      CHECK(units == std::floor(units));
    }
  }
  CHECK(of_fixed > 0);
  CHECK(4 * of_fixed < of_half);
}

}  // namespace
}  // namespace sgs::test
