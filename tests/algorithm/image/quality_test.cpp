// quality.h against hand-computed values and a direct SSIM.
#include "algorithm/image/quality.h"

#include <tbb/global_control.h>

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

constexpr float kInfiniteValue = std::numeric_limits<float>::infinity();

// SSIM from its definition: at every pixel a double sum over the 11x11 window, zeros outside.
double direct_ssim(const Image& a, const Image& b) {
  double window[11][11], total = 0;
  for (int j = 0; j < 11; ++j) {
    for (int i = 0; i < 11; ++i) {
      window[j][i] = std::exp(-((i - 5.0) * (i - 5.0) + (j - 5.0) * (j - 5.0)) / (2 * 1.5 * 1.5));
      total += window[j][i];
    }
  }
  const auto clamped = [](float v) { return std::clamp(static_cast<double>(v), 0.0, 1.0); };
  double sum = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
        for (int j = 0; j < 11; ++j) {
          for (int i = 0; i < 11; ++i) {
            const int px = x + i - 5, py = y + j - 5;
            if (px < 0 || py < 0 || px >= a.width || py >= a.height) continue;
            const double w = window[j][i] / total;
            const double va = clamped(a.at(px, py)[c]), vb = clamped(b.at(px, py)[c]);
            ma += w * va;
            mb += w * vb;
            aa += w * va * va;
            bb += w * vb * vb;
            ab += w * va * vb;
          }
        }
        const double c1 = 1e-4, c2 = 9e-4;
        sum += (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
               ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
      }
    }
  }
  return sum / (3.0 * a.width * a.height);
}

}  // namespace

TEST_CASE("psnr: values by hand") {
  // A difference of 0.1 everywhere is 20 dB; in one of 4 pixels and one of 3 channels, 12 times
  // less: 10 log10(12) = 10.7918 dB more.
  CHECK(psnr_db(flat_image(8, 8, glm::vec3(0.5f)), flat_image(8, 8, glm::vec3(0.6f))) ==
        Approx(20.0).margin(1e-5));
  Image a = flat_image(2, 2, glm::vec3(0.5f)), b = a;
  b.at(1, 0).y += 0.1f;
  CHECK(psnr_db(a, b) == Approx(30.7918).margin(1e-4));
  CHECK(psnr_db(flat_image(3, 3, glm::vec3(0)), flat_image(3, 3, glm::vec3(1))) == Approx(0.0));
}

TEST_CASE("psnr: equal pictures are infinitely alike, NaN is never hidden") {
  const Image a = noise_image(9, 7, 0, 1, 1);
  CHECK(psnr_db(a, a) == std::numeric_limits<double>::infinity());
  Image b = a;
  b.at(3, 3).x = NAN;
  CHECK(std::isnan(psnr_db(a, b)));
}

TEST_CASE("psnr: values are clamped to 0 and 1 first") {
  CHECK(psnr_db(flat_image(2, 2, glm::vec3(1)), flat_image(2, 2, glm::vec3(7))) ==
        std::numeric_limits<double>::infinity());
  CHECK(psnr_db(flat_image(2, 2, glm::vec3(-3)), flat_image(2, 2, glm::vec3(0.1f))) ==
        Approx(20.0).margin(1e-5));
}

TEST_CASE("ssim: equal to its definition at every size") {
  const std::vector<std::pair<int, int>> sizes = {{1, 1},   {1, 40},  {40, 1},  {5, 5},
                                                  {11, 11}, {23, 33}, {17, 70}, {64, 31}};
  for (const auto& [width, height] : sizes) {
    const Image a = noise_image(width, height, -0.1, 1.1, 1);
    Image b = a;
    const Image noise = noise_image(width, height, -0.2, 0.2, 2);
    for (std::size_t i = 0; i < b.pixels.size(); ++i) b.pixels[i] += noise.pixels[i];
    CAPTURE(width, height);
    CHECK(ssim(a, b) == Approx(direct_ssim(a, b)).epsilon(1e-10));
    CHECK(ssim(a, b) == ssim(b, a));
    CHECK(ssim(a, b) < 0.999);
  }
}

TEST_CASE("ssim: 1 for equal pictures, by hand for single pixels") {
  const Image a = noise_image(40, 30, 0, 1, 3);
  CHECK(ssim(a, a) == Approx(1.0).epsilon(1e-12));
  // One pixel: the window holds its weight w at the middle and zeros, so the means are w v, the
  // variances w v^2 - (w v)^2.
  double row = 0;
  for (int i = -5; i <= 5; ++i) row += std::exp(-i * i / 4.5);
  const double w = 1.0 / (row * row), v = 0.5, u = 0.25;
  const double expected = (2 * w * v * w * u + 1e-4) * (2 * (w * v * u - w * w * v * u) + 9e-4) /
                          ((w * v * w * v + w * u * w * u + 1e-4) *
                           (w * v * v - w * w * v * v + w * u * u - w * w * u * u + 9e-4));
  CHECK(ssim(flat_image(1, 1, glm::vec3(0.5f)), flat_image(1, 1, glm::vec3(0.25f))) ==
        Approx(expected).epsilon(1e-12));
}

TEST_CASE("ssim: a NaN of either sign, in either picture or both, is never hidden") {
  const Image a = noise_image(9, 7, 0, 1, 3);
  for (const float nan : {NAN, -NAN}) {
    for (const int in : {1, 2, 3}) {
      CAPTURE(std::signbit(nan), in);
      Image left = a, right = a;
      if ((in & 1) != 0) left.at(3, 3).y = nan;
      if ((in & 2) != 0) right.at(3, 3).y = nan;
      CHECK(std::isnan(ssim(left, right)));
      CHECK_FALSE(std::signbit(ssim(left, right)));
    }
  }
}

TEST_CASE("ssim: the same bits on one thread") {
  const Image a = noise_image(200, 150, 0, 1, 4), b = noise_image(200, 150, 0, 1, 5);
  const double parallel = ssim(a, b);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(ssim(a, b) == parallel);
}

TEST_CASE("max abs error: the largest channel difference, not clamped") {
  Image a = flat_image(4, 3, glm::vec3(0.5f)), b = a;
  CHECK(max_abs_error(a, b) == 0.0);
  b.at(3, 2).z = 2.75f;
  b.at(0, 0).x = 0.0f;
  CHECK(max_abs_error(a, b) == 2.25);
  CHECK(max_abs_error(b, a) == 2.25);
  b.at(1, 1).y = NAN;
  CHECK(max_abs_error(a, b) == std::numeric_limits<double>::infinity());
  a.at(1, 1).y = NAN;
  CHECK(max_abs_error(a, b) == 2.25);  // NaN in both is no difference
  a.at(2, 2).x = b.at(2, 2).x = kInfiniteValue;
  CHECK(max_abs_error(a, b) == 2.25);
  b.at(2, 2).x = -kInfiniteValue;
  CHECK(max_abs_error(a, b) == std::numeric_limits<double>::infinity());
}

TEST_CASE("fraction within: pixels whose three channels are close") {
  Image a = flat_image(4, 2, glm::vec3(0.5f)), b = a;
  CHECK(fraction_within(a, b, 0.0) == 1.0);
  b.at(0, 0).x += 0.25f;
  b.at(0, 0).y += 0.25f;
  b.at(1, 0).z -= 0.125f;
  CHECK(fraction_within(a, b, 0.0) == 0.75);
  CHECK(fraction_within(a, b, 0.125) == 0.875);
  CHECK(fraction_within(a, b, 0.25) == 1.0);
  b.at(2, 1).x = NAN;
  CHECK(fraction_within(a, b, 1e30) == 0.875);
}

TEST_CASE("comparisons refuse pictures of different or no size") {
  const Image a = flat_image(4, 2, glm::vec3(0)), b = flat_image(2, 4, glm::vec3(0)), none;
  CHECK_THROWS_AS(psnr_db(a, b), InputError);
  CHECK_THROWS_AS(ssim(a, b), InputError);
  CHECK_THROWS_AS(max_abs_error(a, b), InputError);
  CHECK_THROWS_AS(fraction_within(a, b, 1), InputError);
  CHECK_THROWS_AS(psnr_db(none, none), InputError);
}

TEST_CASE("differing pixels: those of which any channel differs") {
  Image a = noise_image(7, 5, 0.0, 1.0, 1);
  Image b = a;
  CHECK(differing_pixels(a, b) == 0);
  b.at(3, 2).y = std::nextafter(b.at(3, 2).y, 2.0F);
  b.at(6, 4) += 1.0F;
  CHECK(differing_pixels(a, b) == 2);
  a.at(0, 0).x = b.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
  CHECK(differing_pixels(a, b) == 2);
  b.at(0, 0).x = 0;
  CHECK(differing_pixels(a, b) == 3);
  CHECK_THROWS_AS(differing_pixels(a, Image(5, 7)), InputError);
}
