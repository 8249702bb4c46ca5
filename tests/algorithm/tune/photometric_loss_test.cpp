// The loss against image/quality.h and against differences.
#include "algorithm/tune/photometric_loss.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "algorithm/files/input_error.h"
#include "algorithm/image/quality.h"

namespace sgs::test {
namespace {

struct Size {
  int width, height;
};
// Smaller than the window, as large, larger; no multiple of anything.
const Size kSizes[] = {{1, 1}, {3, 2}, {11, 11}, {40, 7}, {23, 31}};

std::vector<double> random_values(const Size& size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> out(static_cast<std::size_t>(3 * size.width * size.height));
  for (double& v : out) v = uniform(random);
  return out;
}

// Like a photograph beside its picture: smooth, and nearly equal.
std::vector<double> similar_to(const std::vector<double>& values, unsigned seed) {
  std::vector<double> out = values;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 0.05);
  for (double& v : out) v = std::min(1.0, std::max(0.0, v + normal(random)));
  return out;
}

Image image_of(const std::vector<double>& values, const Size& size) {
  Image out(size.width, size.height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.pixels[i / 3][static_cast<int>(i % 3)] = static_cast<float>(values[i]);
  }
  return out;
}

double loss_in_double(const std::vector<double>& a, const std::vector<double>& b, const Size& size,
                      double lambda) {
  return photometric_loss(a.data(), b.data(), size.width, size.height, lambda).loss;
}

TEST_CASE("the loss is made of the SSIM of the measures and of the mean difference") {
  for (const Size& size : kSizes) {
    const std::vector<double> a = random_values(size, 1), b = similar_to(a, 2);
    const Image picture = image_of(a, size), target = image_of(b, size);
    double l1 = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        l1 += std::abs(static_cast<double>(picture.pixels[i][k]) - target.pixels[i][k]);
      }
    }
    l1 /= static_cast<double>(a.size());
    const double similarity = ssim(picture, target);
    for (const double lambda : {0.0, 0.2, 1.0}) {
      INFO(size.width << " x " << size.height);
      const ImageLoss loss = photometric_loss(picture, target, lambda);
      CHECK(loss.ssim == Approx(similarity).margin(1e-5));
      CHECK(loss.l1 == Approx(l1).epsilon(1e-6));
      CHECK(loss.loss == Approx((1 - lambda) * l1 + lambda * (1 - similarity)).margin(1e-5));
      // The pictures as the measure sees them: floats.
      std::vector<double> p, t;
      for (const auto& v : picture.pixels) p.insert(p.end(), {v.x, v.y, v.z});
      for (const auto& v : target.pixels) t.insert(t.end(), {v.x, v.y, v.z});
      const auto exact = photometric_loss(p.data(), t.data(), size.width, size.height, lambda);
      CHECK(exact.ssim == Approx(similarity).margin(1e-12));
    }
  }
}

TEST_CASE("the gradient of the loss is that of central differences") {
  constexpr double kStep = 1e-5;
  for (const Size& size : kSizes) {
    for (const bool similar : {false, true}) {
      std::vector<double> a = random_values(size, 3);
      const std::vector<double> b = similar ? similar_to(a, 4) : random_values(size, 4);
      for (const double lambda : {0.0, 0.2, 1.0}) {
        const auto loss = photometric_loss(a.data(), b.data(), size.width, size.height, lambda);
        const auto in_float = photometric_loss(image_of(a, size), image_of(b, size), lambda);
        double scale = 0;
        for (const double g : loss.gradient) scale = std::max(scale, std::abs(g));
        for (std::size_t i = 0; i < a.size(); ++i) {
          const double value = a[i];
          if (std::abs(value - b[i]) < 3 * kStep) continue;  // L1 bends there
          const auto at = [&](double steps) {
            a[i] = value + steps * kStep;
            return loss_in_double(a, b, size, lambda);
          };
          const double slope = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kStep);
          a[i] = value;
          INFO(size.width << " x " << size.height << ", value " << i << ", lambda " << lambda);
          REQUIRE(std::abs(loss.gradient[i] - slope) <= 1e-5 * std::abs(slope) + 1e-7 * scale);
          const float single = in_float.gradient.pixels[i / 3][static_cast<int>(i % 3)];
          REQUIRE(std::abs(single - slope) <= 2e-4 * scale);
        }
      }
    }
  }
}

TEST_CASE("equal pictures: no loss, no gradient") {
  const Size size{23, 31};
  const Image picture = image_of(random_values(size, 5), size);
  const ImageLoss loss = photometric_loss(picture, picture);
  CHECK(loss.l1 == 0);
  CHECK(loss.ssim == Approx(1).margin(1e-6));
  const auto exact = random_values(size, 5);
  const auto in_double = photometric_loss(exact.data(), exact.data(), size.width, size.height);
  for (const double g : in_double.gradient) REQUIRE(std::abs(g) < 1e-15);
}

TEST_CASE("pictures of two sizes have no loss") {
  CHECK_THROWS_AS(photometric_loss(Image(3, 2), Image(2, 3)), InputError);
  CHECK_THROWS_AS(photometric_loss(Image(), Image()), InputError);
}

}  // namespace
}  // namespace sgs::test
