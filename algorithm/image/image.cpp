// Backgrounds and area averages of pictures with alpha.
#include "algorithm/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

// The source pixels that one pixel of the result covers, along one axis.
struct Span {
  int first = 0;
  std::vector<float> weights;  // share of the result that each of them from `first` gives; sum 1
};

std::vector<Span> spans_of(int from, int to) {
  std::vector<Span> spans(static_cast<std::size_t>(to));
  const double length = static_cast<double>(from) / to;  // source pixels a pixel of the result
  for (int i = 0; i < to; ++i) {
    Span& span = spans[static_cast<std::size_t>(i)];
    // i * from / to in integers: where borders of both coincide there is no rounding.
    const std::int64_t begin = std::int64_t{i} * from, end = (std::int64_t{i} + 1) * from;
    span.first = static_cast<int>(begin / to);
    for (std::int64_t at = span.first; at * to < end; ++at) {
      const auto covered = std::min((at + 1) * to, end) - std::max(at * to, begin);
      span.weights.push_back(static_cast<float>(static_cast<double>(covered) / to / length));
    }
  }
  return spans;
}

// The mean along rows; pixels of one row lie `step` apart, rows `row_step`.
void average_rows(const glm::vec4* from, std::size_t step, std::size_t row_step,
                  const std::vector<Span>& spans, std::size_t rows, glm::vec4* to,
                  std::size_t to_step, std::size_t to_row_step) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < spans.size(); ++i) {
      const glm::vec4* pixel =
          from + row * row_step + static_cast<std::size_t>(spans[i].first) * step;
      glm::vec4 sum(0);
      for (const float weight : spans[i].weights) {
        sum += weight * *pixel;
        pixel += step;
      }
      to[row * to_row_step + i * to_step] = sum;
    }
  }
}

}  // namespace

Image over(const RgbaImage& image, const glm::vec3& background) {
  Image out(image.width, image.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const glm::vec4& pixel = image.pixels[i];
    out.pixels[i] = glm::vec3(pixel) + background * (1.0f - pixel.w);
  }
  return out;
}

RgbaImage area_averaged(const RgbaImage& image, int width, int height) {
  if (width < 1 || height < 1 || width > image.width || height > image.height) {
    throw InputError(
        fmt::format("image of {}x{} px averaged to {}x{}: expected a size from 1 to "
                    "its own",
                    image.width, image.height, width, height));
  }
  if (width == image.width && height == image.height) return image;
  const auto from_width = static_cast<std::size_t>(image.width);
  const auto to_width = static_cast<std::size_t>(width);
  RgbaImage narrow(width, image.height);
  average_rows(image.pixels.data(), 1, from_width, spans_of(image.width, width),
               static_cast<std::size_t>(image.height), narrow.pixels.data(), 1, to_width);
  RgbaImage out(width, height);
  average_rows(narrow.pixels.data(), to_width, 1, spans_of(image.height, height), to_width,
               out.pixels.data(), to_width, 1);
  return out;
}

}  // namespace sgs
