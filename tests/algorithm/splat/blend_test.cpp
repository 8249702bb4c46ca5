// Tests of algorithm/splat/blend.h: section 3 of the rendering semantics.
#include "algorithm/splat/blend.h"

#include <Imath/half.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>

#include "algorithm/splat/half_scalar.h"

using namespace sgs;

namespace {

// A splat that covers everything with the same alpha.
Splat flat(float alpha, glm::vec3 rgb) {
  Splat s{};
  s.opacity = alpha;
  s.rgb = rgb;
  s.footprint = {0, 0, 100, 100};
  return s;
}

// One pixel, one splat, straight from section 3, in the arithmetic of the kernel.
void blend_pixel(SubtileState& state, int lane, float dx, float dy, const Splat& s) {
  if (state.active[lane] == 0) return;
  // log2(e) in the conic.
  const float a = s.conic_a * -0.721347520F, b = s.conic_b * -1.44269504F;
  const float c = s.conic_c * -0.721347520F;
  const float exponent = (a * dx * dx + c * dy * dy) + b * dx * dy;
  if (exponent > 0) return;
  const float alpha = std::min(0.99F, s.opacity * exp2_of(exponent));
  if (alpha < 1.0F / 255) return;
  const float before = state.transmittance[lane], weight = alpha * before;
  const float after = before - weight;
  if (after < 0.0001F) {
    state.active[lane] = 0;
    return;
  }
  state.red[lane] += s.rgb.x * weight;
  state.green[lane] += s.rgb.y * weight;
  state.blue[lane] += s.rgb.z * weight;
  state.transmittance[lane] = after;
  ++state.contributors[lane];
}

// Whether the shares say what led from one state to the other.
bool explains(const LaneShares& shares, const SubtileState& before, const SubtileState& after,
              const Splat& s) {
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const float alpha = shares.alpha[lane], t = shares.before[lane];
    const bool blended = after.contributors[lane] != before.contributors[lane];
    if (blended != (alpha > 0) || t != before.transmittance[lane]) return false;
    if (after.transmittance[lane] != t - alpha * t) return false;
    if (after.red[lane] != before.red[lane] + s.rgb.x * (alpha * t)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("alpha: capped at 0.99, nothing below 1/255, nothing where power rises above 0") {
  CHECK(alpha_at(1.0, 0.0, 1.0, 1.0, 0.0, 0.0) == 0.99);
  CHECK(alpha_at(1.0F, 0.0F, 1.0F, 1.0F, 0.0F, 0.0F) == 0.99F);
  const float least = 1.0F / 255;
  CHECK(alpha_at(0.0F, 0.0F, 0.0F, least, 0.0F, 0.0F) == least);
  CHECK(alpha_at(0.0F, 0.0F, 0.0F, std::nextafter(least, 0.0F), 0.0F, 0.0F) == 0);
  CHECK(alpha_at(1.0F, -2.0F, 1.0F, 0.5F, 1.0F, 1.0F) == 0);  // power = -1 + 2
  // A power that is no number: inf - inf.
  CHECK(alpha_at(1.0F, -1.0F, 1.0F, 0.5F, 1e30F, 1e30F) == 0);
}

TEST_CASE("a fresh sub-tile: light undiminished, pixels outside the frame finished") {
  const SubtileState inside = make_subtile(0, 0, 8, 8);
  CHECK_FALSE(finished(inside));
  const SubtileState corner = make_subtile(1, 1, 6, 7);  // 2x3 pixels of it are in the frame
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    CAPTURE(lane);
    CHECK(inside.active[lane] == -1);
    CHECK(inside.transmittance[lane] == 1);
    CHECK(inside.red[lane] + inside.green[lane] + inside.blue[lane] == 0);
    CHECK(inside.contributors[lane] == 0);
    CHECK(corner.active[lane] == (lane % 4 < 2 && lane / 4 < 3 ? -1 : 0));
  }
  CHECK(finished(make_subtile(2, 0, 8, 8)));
}

TEST_CASE("exactly 1e-4 is not below: T' equal to the threshold is blended") {
  SubtileState state = make_subtile(0, 0, 4, 4);
  state.transmittance[0] = 0.0002F;
  const float alpha = 0.5F;
  REQUIRE(0.0002F - 0.0002F * alpha == 0.0001F);
  blend(state, 0, 0, flat(alpha, {1, 1, 1}));
  CHECK(state.contributors[0] == 1);
  CHECK(state.active[0] == -1);
}

TEST_CASE("the vector kernel equals a scalar loop bit for bit") {
  std::mt19937 random(7);
  const auto uniform = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  long blended = 0, finished_lanes = 0;
  for (int round = 0; round < 400; ++round) {
    const int tile_x = static_cast<int>(random() % 160), tile_y = static_cast<int>(random() % 90);
    SubtileState fast = make_subtile(tile_x, tile_y, 638, 359), slow = fast, told = fast;
    for (int layer = 0; layer < 100; ++layer) {
      Splat s = flat(uniform(0, 1), {uniform(0, 2), uniform(0, 2), uniform(0, 2)});
      if (layer % 10 == 0) s.opacity = uniform(0.0035F, 0.0045F);
      if (layer % 11 == 0) s.opacity = 1;
      const float sharp = std::exp(uniform(-12, 1.2F));
      s.conic_a = sharp * uniform(0.1F, 1);
      s.conic_c = sharp * uniform(0.1F, 1);
      // Now and then indefinite, as rounding leaves the conics of needles.
      s.conic_b = std::sqrt(s.conic_a * s.conic_c) * uniform(-1.0001F, 1.0001F);
      s.x = static_cast<float>(4 * tile_x) + uniform(-2, 5) + uniform(-1, 1) / std::sqrt(sharp);
      s.y = static_cast<float>(4 * tile_y) + uniform(-2, 5) + uniform(-1, 1) / std::sqrt(sharp);
      const SubtileState before = fast;
      blend(fast, tile_x, tile_y, s);
      const LaneShares shares = blend_and_tell(told, tile_x, tile_y, s);
      for (int lane = 0; lane < kSubtilePixels; ++lane) {
        const float left = s.x - static_cast<float>(4 * tile_x);
        const float top = s.y - static_cast<float>(4 * tile_y);
        blend_pixel(slow, lane, left - static_cast<float>(lane % 4),
                    top - static_cast<float>(lane / 4), s);
      }
      if (std::memcmp(&fast, &slow, sizeof fast) != 0 ||
          std::memcmp(&fast, &told, sizeof fast) != 0 || !explains(shares, before, fast, s))
        FAIL("round " << round << " layer " << layer);
    }
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      blended += fast.contributors[lane];
      finished_lanes += fast.active[lane] == 0;
    }
  }
  CHECK(blended > 50000);
  CHECK(finished_lanes > 1000);
}

TEST_CASE(
    "a float rounds to the half that is nearest: all halves, the middles between, and beside") {
  using Imath::half;
  int wrong = 0;
  const auto right = [&](float x) {
    const float nearest = static_cast<float>(half(x));
    const float within = std::isinf(nearest) ? std::copysign(kLargestHalf, x) : nearest;
    wrong += rounded_to_half(x) == nearest ? 0 : 1;
    wrong += clamped_to_half(x) == within ? 0 : 1;
  };
  for (unsigned bits = 0; bits < 0x7c00; ++bits) {
    half h, above;
    h.setBits(static_cast<std::uint16_t>(bits));
    above.setBits(static_cast<std::uint16_t>(bits + 1));
    const float low = h, high = bits + 1 < 0x7c00 ? static_cast<float>(above) : 65536.0F;
    const float middle = 0.5F * low + 0.5F * high;
    for (const float x : {low, middle, std::nextafter(middle, low), std::nextafter(middle, high)}) {
      right(x);
      right(-x);
    }
  }
  right(1e30F);
  right(-1e30F);
  right(INFINITY);
  CHECK(wrong == 0);
  CHECK(std::isnan(rounded_to_half(NAN)));
}

TEST_CASE("blending in half: within what its roundings allow of blending in float") {
  // Each splat's alpha is off by some 2^-11 times the size of its power's terms; a dozen layers add
  // up. Needles at 45 degrees are left out: there the terms cancel.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-40, 40), opacity(0.05F, 0.95F), shade(0, 1);
  std::uniform_real_distribution<float> log_width(-0.5F, 6.5F);
  float worst = 0;
  for (int round = 0; round < 300; ++round) {
    SubtileState single = make_subtile(3, 5, 100, 100), in_half = single;
    for (int layer = 0; layer < 12; ++layer) {
      Splat s{};
      const float width = std::exp(log_width(random));
      s.conic_a = 1 / (width * width);
      s.conic_c = s.conic_a * (0.5F + shade(random));
      s.conic_b = 0.3F * s.conic_a;
      s.x = 14 + place(random) * std::min(1.0F, width / 20);
      s.y = 22 + place(random) * std::min(1.0F, width / 20);
      s.opacity = opacity(random);
      s.rgb = {shade(random), shade(random), shade(random)};
      blend(single, 3, 5, s);
      blend(in_half, 3, 5, square_splat(s));
    }
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      worst = std::max(worst, std::abs(single.red[lane] - in_half.red[lane]));
      CHECK(rounded_to_half(in_half.red[lane]) == in_half.red[lane]);
      CHECK(rounded_to_half(in_half.transmittance[lane]) == in_half.transmittance[lane]);
    }
  }
  CHECK(worst > 0);
  CHECK(worst < 0.02F);
}

TEST_CASE("blending in half: a splat wider than a half can say is not lost") {
  // A = 10^-8 is below the least half; at its centre alpha is the opacity.
  Splat s{};
  s.conic_a = s.conic_c = 1e-8F;
  s.opacity = 0.5F;
  s.rgb = {1, 1, 1};
  s.x = 20000;
  SubtileState state = make_subtile(0, 0, 100, 100);
  blend(state, 0, 0, square_splat(s));
  CHECK(state.red[0] == Approx(0.5 * std::exp(-2.0)).epsilon(0.01));  // two sigmas from the centre
}

TEST_CASE(
    "blending in half: far from a needle's centre, where terms are too large, nothing is drawn") {
  struct Needle {
    const char* which;
    float x, y, conic_a, conic_b, conic_c;
  };
  // In float the exponent is below -8 on every pixel, and no pixel is drawn.
  const Needle needles[] = {
      {"from platform, both terms too large", 1082.6F, 775.7F, 0.113709F, -0.440972F, 1.71026F},
      {"from platform, one of them, flat", -1152.9F, 2168.3F, 1.59323e-4F, 0.0188418F, 2.26637F},
      {"from platform, hardly too large", 343.9F, 262.5F, 0.441502F, -0.55427F, 0.695975F},
      {"of the other slope", -1082.6F, 775.7F, 0.113709F, 0.440972F, 1.71026F},
      {"upright", 1.6F, 70000, 1.71026F, 0, 1e-6F},
      {"centre beyond the largest half, in its units", 3e6F, 3e6F, 1, -0.9999F, 1},
      {"centre beyond all", 1e30F, -1e30F, 1, 0.5F, 1},
  };
  for (const Needle& needle : needles) {
    CAPTURE(needle.which);
    Splat s{};
    s.x = needle.x;
    s.y = needle.y;
    s.conic_a = needle.conic_a;
    s.conic_b = needle.conic_b;
    s.conic_c = needle.conic_c;
    s.opacity = 0.78F;
    s.rgb = {0.5F, 0.5F, 0.5F};
    SubtileState single = make_subtile(0, 0, 100, 100), in_half = single;
    blend(single, 0, 0, s);
    blend(in_half, 0, 0, square_splat(s));
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      CHECK(single.contributors[lane] == 0);
      CHECK(in_half.contributors[lane] == 0);
      CHECK(in_half.red[lane] == 0);
      CHECK(in_half.transmittance[lane] == 1);
    }
  }
}

TEST_CASE("blending in half: conics at the ends of their range are drawn as in float") {
  struct Row {
    const char* which;
    float conic_a, conic_b, conic_c;
    int pixels;  // blended, of a splat at the third pixel of the second row
  };
  constexpr float kTiny = std::numeric_limits<float>::min(), kInfinite = INFINITY;
  const Row rows[] = {
      {"0: as opaque everywhere", 0, 0, 0, 16},
      {"tiny", kTiny, 0, kTiny, 16},
      {"subnormal", kTiny / 64, 0, kTiny / 64, 16},
      {"A is 0: a line along x", 0, 0, 3, 12},
      {"C is 0: a line along y", 3, 0, 0, 12},
      {"A is tiny", kTiny, 1e-20F, 3, 12},
      {"A is tiny, B is its root", 1e-30F, 1e-15F, 3, 12},
      {"C is tiny", 3, 1e-20F, kTiny, 12},
      {"C is tiny, B is its root", 3, 1e-15F, 1e-30F, 12},
      {"A is 0, and the ellipse leans", 0, 1e-4F, 3, 12},
      {"a needle along x, hardly leaning", 1e-7F, 3e-4F, 3, 12},
      {"a needle at 45 degrees", 1.6F, -1.599999F, 1.6F, 13},
      {"power rises above 0 on a diagonal", 1, -2, 1, 9},
      {"sharper than any", 1e6F, -1e5F, 1e6F, 1},
      {"A is infinite", kInfinite, 0, 1, 0},
      {"C is infinite", 1, 0, kInfinite, 0},
      {"B is infinite", 1, kInfinite, 1, 0},
      {"A is no number", NAN, 0, 1, 0},
      {"B is no number", 1, NAN, 1, 0},
      {"C is no number", 1, 0, NAN, 0},
  };
  for (const Row& row : rows) {
    CAPTURE(row.which);
    Splat s{};
    s.x = 2;
    s.y = 1;
    s.conic_a = row.conic_a;
    s.conic_b = row.conic_b;
    s.conic_c = row.conic_c;
    s.opacity = 0.75F;
    s.rgb = {1, 1, 1};
    SubtileState single = make_subtile(0, 0, 100, 100), in_half = single;
    blend(single, 0, 0, s);
    blend(in_half, 0, 0, square_splat(s));
    int pixels = 0;
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      CAPTURE(lane, single.red[lane], in_half.red[lane]);
      pixels += in_half.contributors[lane];
      CHECK(in_half.contributors[lane] == single.contributors[lane]);
      CHECK(in_half.red[lane] == Approx(single.red[lane]).epsilon(0.005));
    }
    CHECK(pixels == row.pixels);
  }
}

TEST_CASE("blending in half: a needle is as long and as wide as in float, at every angle") {
  // 0.3 px^2 across, 1,000 px of one sigma along; through the middle of a sub-tile 600 px from its
  // centre. Three terms of some 1,000 each cancel there to less than one.
  for (int degree = 0; degree < 180; degree += 3) {
    CAPTURE(degree);
    const double angle = degree * M_PI / 180, x = std::cos(angle), y = std::sin(angle);
    constexpr double kAlong = 1 / 1e6, kAcross = 1 / 0.3;
    Splat s{};
    s.conic_a = static_cast<float>(kAlong * x * x + kAcross * y * y);
    s.conic_b = static_cast<float>((kAlong - kAcross) * x * y);
    s.conic_c = static_cast<float>(kAlong * y * y + kAcross * x * x);
    s.x = static_cast<float>(1.5 + 600 * x);
    s.y = static_cast<float>(1.5 + 600 * y);
    s.opacity = 0.75F;
    s.rgb = {1, 1, 1};
    SubtileState single = make_subtile(0, 0, 100, 100), in_half = single;
    blend(single, 0, 0, s);
    blend(in_half, 0, 0, square_splat(s));
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      CAPTURE(lane, single.red[lane], in_half.red[lane]);
      CHECK(std::abs(in_half.red[lane] - single.red[lane]) < 0.2F);
    }
  }
}

TEST_CASE("blending in half: a colour beyond the largest half leaves pixels that it misses alone") {
  Splat s{};
  s.conic_a = s.conic_c = 1;
  s.opacity = 0.5F;
  s.rgb = {1e30F, 1, INFINITY};
  SubtileState state = make_subtile(0, 0, 100, 100);
  for (int layer = 0; layer < 3; ++layer) blend(state, 0, 0, square_splat(s));
  constexpr int kFarthest = kSubtilePixels - 1;
  CHECK(state.red[kFarthest] == 0);
  CHECK(state.red[0] > 57000);
  CHECK_FALSE(std::isnan(state.blue[0]));
}
