// Measures that look at one pixel at a time, then SSIM: separable Gaussian window, bands of rows in
// parallel.
#include "algorithm/image/quality.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {

double channel_error(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double error = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

constexpr int kBandRows = 32;  // ten more are filtered twice; larger bands leave cores idle

// Window sums at one pixel of one channel: a, b, a^2, b^2, a b.
using Moments = std::array<double, 5>;

Moments moments_of(float a_value, float b_value) {
  const double a = clamp_to_unit(a_value), b = clamp_to_unit(b_value);
  return {a, b, a * a, b * b, a * b};
}

double ssim_of(const Moments& m) {
  const double mean_product = m[0] * m[1];
  const double mean_squares = m[0] * m[0] + m[1] * m[1];
  const double variances = m[2] + m[3] - mean_squares;
  const double covariance = m[4] - mean_product;
  return (2.0 * mean_product + kSsimC1) * (2.0 * covariance + kSsimC2) /
         ((mean_squares + kSsimC1) * (variances + kSsimC2));
}

// The filter across one row: out[3 x + channel].
void filter_row(const Image& a, const Image& b, int y, const std::array<double, kSsimTaps>& window,
                std::vector<Moments>& raw, Moments* out) {
  raw.assign(3 * (static_cast<std::size_t>(a.width) + 2 * kSsimRadiusPx), Moments{});
  for (int x = 0; x < a.width; ++x) {
    for (int channel = 0; channel < 3; ++channel) {
      raw[3 * (x + kSsimRadiusPx) + channel] = moments_of(a.at(x, y)[channel], b.at(x, y)[channel]);
    }
  }
  for (int i = 0; i < 3 * a.width; ++i) {
    Moments sum{};
    for (int tap = 0; tap < kSsimTaps; ++tap) {
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += window[tap] * raw[i + 3 * tap][k];
    }
    out[i] = sum;
  }
}

}  // namespace

double pixel_error(const glm::vec3& a, const glm::vec3& b) {
  return std::max({channel_error(a.x, b.x), channel_error(a.y, b.y), channel_error(a.z, b.z)});
}

void check_same_size(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height && !a.pixels.empty() &&
      a.pixels.size() == b.pixels.size()) {
    return;
  }
  throw InputError(fmt::format(
      "comparing images: sizes {}x{} and {}x{}, expected the same size and at least one pixel",
      a.width, a.height, b.width, b.height));
}

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

double ssim(const Image& a, const Image& b) {
  check_same_size(a, b);
  const std::array<double, kSsimTaps> window = ssim_window();
  const std::size_t row_size = 3 * static_cast<std::size_t>(a.width);
  std::vector<double> row_sums(a.height, 0.0);
  const int bands = (a.height + kBandRows - 1) / kBandRows;
  tbb::parallel_for(0, bands, [&](int band) {
    const int begin = band * kBandRows, end = std::min(a.height, begin + kBandRows);
    const int first = std::max(0, begin - kSsimRadiusPx),
              last = std::min(a.height, end + kSsimRadiusPx);
    std::vector<Moments> filtered(row_size * (last - first)), raw;
    for (int y = first; y < last; ++y) {
      filter_row(a, b, y, window, raw, &filtered[row_size * (y - first)]);
    }
    for (int y = begin; y < end; ++y) {
      for (std::size_t i = 0; i < row_size; ++i) {
        Moments sum{};
        for (int tap = 0; tap < kSsimTaps; ++tap) {
          const int row = y + tap - kSsimRadiusPx;
          if (row < 0 || row >= a.height) continue;  // zero padding
          const Moments& m = filtered[row_size * (row - first) + i];
          for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += window[tap] * m[k];
        }
        row_sums[y] += ssim_of(sum);
      }
    }
  });
  const double mean = std::accumulate(row_sums.begin(), row_sums.end(), 0.0) /
                      static_cast<double>(row_size * row_sums.size());
  // Whatever the sign of a picture's NaN, it is printed as one.
  return std::isnan(mean) ? std::numeric_limits<double>::quiet_NaN() : mean;
}

std::vector<ErrorPart> error_parts(const std::vector<const Image*>& chain) {
  const Image& first = *chain.front();
  for (const Image* image : chain) check_same_size(first, *image);
  std::vector<ErrorPart> parts(chain.size() - 1);
  double whole = 0;
  for (std::size_t pixel = 0; pixel < first.pixels.size(); ++pixel) {
    const auto shown = [&](const Image& image) {
      return glm::dvec3(clamp_to_unit(image.pixels[pixel]));
    };
    const glm::dvec3 error = shown(*chain.back()) - shown(first);
    whole += glm::dot(error, error);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const glm::dvec3 step = shown(*chain[i + 1]) - shown(*chain[i]);
      parts[i].share += glm::dot(step, error);
      parts[i].alone += glm::dot(step, step);
    }
  }
  for (ErrorPart& part : parts) {
    part.share /= whole;
    part.alone /= whole;
  }
  return parts;
}

}  // namespace sgs
