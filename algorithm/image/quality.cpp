// PSNR and the measures that look at one pixel at a time.
#include "algorithm/image/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "algorithm/image/image_pair.h"

namespace sgs {
namespace {

// |a - b| of one channel. Equal infinities and two NaN agree; a NaN on one side must not hide.
double channel_error(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double error = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

double pixel_error(const glm::vec3& a, const glm::vec3& b) {
  return std::max({channel_error(a.x, b.x), channel_error(a.y, b.y), channel_error(a.z, b.z)});
}

glm::vec3 error_colour(double error) {
  static const std::array<glm::vec3, 6> kByDecade = {glm::vec3(0, 0, 0), glm::vec3(0, 0, 1),
                                                     glm::vec3(0, 1, 0), glm::vec3(1, 1, 0),
                                                     glm::vec3(1, 0, 0), glm::vec3(1, 1, 1)};
  if (error <= 1e-5) return kByDecade.front();
  if (error >= 1.0) return kByDecade.back();
  const double decade = std::log10(error) + 5.0;
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(decade), 4);
  const auto mix = static_cast<float>(decade - static_cast<double>(below));
  return glm::mix(kByDecade[below], kByDecade[below + 1], mix);
}

}  // namespace

double psnr_db(const Image& a, const Image& b) {
  check_same_size(a, b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const double difference = clamp_to_unit(a.pixels[i][channel]) -
                                static_cast<double>(clamp_to_unit(b.pixels[i][channel]));
      sum += difference * difference;
    }
  }
  return -10.0 * std::log10(sum / (3.0 * static_cast<double>(a.pixels.size())));
}

double max_abs_error(const Image& a, const Image& b) {
  check_same_size(a, b);
  double largest = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    largest = std::max(largest, pixel_error(a.pixels[i], b.pixels[i]));
  }
  return largest;
}

double fraction_within(const Image& a, const Image& b, double tolerance) {
  check_same_size(a, b);
  std::size_t within = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (pixel_error(a.pixels[i], b.pixels[i]) <= tolerance) ++within;
  }
  return static_cast<double>(within) / static_cast<double>(a.pixels.size());
}

Image error_image(const Image& a, const Image& b) {
  check_same_size(a, b);
  Image result(a.width, a.height);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    result.pixels[i] = error_colour(pixel_error(a.pixels[i], b.pixels[i]));
  }
  return result;
}

}  // namespace sgs
