// PSNR and the measures that look at one pixel at a time.
#include "algorithm/image/quality.h"

#include <algorithm>
#include <cmath>

#include "algorithm/image/image_pair.h"

namespace sgs {

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

std::uint64_t differing_pixels(const Image& a, const Image& b) {
  check_same_size(a, b);
  std::uint64_t differing = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (pixel_error(a.pixels[i], b.pixels[i]) > 0) ++differing;
  }
  return differing;
}

double fraction_within(const Image& a, const Image& b, double tolerance) {
  check_same_size(a, b);
  std::size_t within = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (pixel_error(a.pixels[i], b.pixels[i]) <= tolerance) ++within;
  }
  return static_cast<double>(within) / static_cast<double>(a.pixels.size());
}

}  // namespace sgs
