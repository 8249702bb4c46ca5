// Backgrounds and area averages of pictures with alpha.
#include "algorithm/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
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

// A glyph has an octal digit a row, the top row first; the leftmost dot is its highest bit.
constexpr std::string_view kCharacters = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ.%-+<";
constexpr int kGlyphs[] = {
    075557, 026227, 071747, 071717, 055711, 074717, 074757, 071222, 075757, 075717,  // 0-9
    025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755, 072227, 011152,  // A-J
    055655, 044447, 057755, 065555, 025552, 065644, 025563, 065655, 034216, 072222,  // K-T
    055557, 055552, 055775, 055255, 055222, 071247,                                  // U-Z
    000002, 051245, 000700, 002720, 012421};
static_assert(sizeof kGlyphs / sizeof *kGlyphs == kCharacters.size());

int glyph_of(char c) {
  const char capital = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  const std::size_t at = kCharacters.find(capital);
  return at == std::string_view::npos ? 0 : kGlyphs[at];
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

void fill_rect(Image& image, int x, int y, int width, int height, const glm::vec3& colour) {
  const int right = std::min(x + width, image.width), bottom = std::min(y + height, image.height);
  for (int row = std::max(y, 0); row < bottom; ++row) {
    for (int column = std::max(x, 0); column < right; ++column) image.at(column, row) = colour;
  }
}

void draw_text(Image& image, int x, int y, int dot_px, std::string_view text,
               const glm::vec3& colour) {
  for (const char c : text) {
    const int glyph = glyph_of(c);
    for (int row = 0; row < kGlyphRows; ++row) {
      for (int column = 0; column < kGlyphColumns; ++column) {
        const int bit = (kGlyphRows - 1 - row) * 3 + (kGlyphColumns - 1 - column);
        if ((glyph >> bit & 1) == 0) continue;
        fill_rect(image, x + column * dot_px, y + row * dot_px, dot_px, dot_px, colour);
      }
    }
    x += (kGlyphColumns + 1) * dot_px;
  }
}

}  // namespace sgs
