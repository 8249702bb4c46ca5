// Colours of errors, and the legend.
#include "algorithm/image/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "algorithm/image/image.h"
#include "algorithm/image/quality.h"

namespace sgs {
namespace {

// Even steps of lightness (0.32 to 0.97) and of hue (280 to 470 degrees) in OKLab, with as much
// chroma as sRGB can show, at most 0.16.
constexpr std::array<glm::vec3, 8> kRamp = {
    glm::vec3(0.17F, 0.10F, 0.50F), glm::vec3(0.39F, 0.16F, 0.55F), glm::vec3(0.60F, 0.22F, 0.54F),
    glm::vec3(0.79F, 0.31F, 0.48F), glm::vec3(0.93F, 0.44F, 0.38F), glm::vec3(0.99F, 0.62F, 0.34F),
    glm::vec3(1.00F, 0.81F, 0.45F), glm::vec3(0.99F, 1.00F, 0.45F)};

// 0 at kLeastShownError, 1 at an error of 1.
double place_of(double error) { return 1 - std::log10(error) / std::log10(kLeastShownError); }
double error_at(double place) { return std::pow(kLeastShownError, 1 - place); }

// The errors that the legend names, beside kLeastShownError; 0.004 is one step of 8 bits.
constexpr std::array<double, 6> kNamedErrors = {1, 0.3, 0.1, 0.03, 0.01, 0.004};

const glm::vec3 kPaper(0.2F), kInk(0.9F);

// In dots of the font.
constexpr int kMargin = 4, kLine = kGlyphRows + 3;
constexpr int kBarWidth = 8, kBarToLabel = 4, kLabelLength = 5;
constexpr int kBarMin = 80, kBarMax = 120;  // the named values stand apart; no longer than needed

// Sizes that follow from the pictures and the caption.
struct Legend {
  Legend(const Image& picture, const std::vector<std::string>& lines)
      : dot_px(std::max(2, std::min(picture.width, picture.height) / 180)) {
    int widest = kBarWidth + kBarToLabel + text_dots(kLabelLength);
    for (const std::string& line : lines) {
      widest = std::max(widest, text_dots(static_cast<int>(line.size())));
    }
    width_px = (widest + 2 * kMargin) * dot_px;
    bar_top = kMargin + (static_cast<int>(lines.size()) + 1) * kLine;
    const int room = picture.height / dot_px - bar_top - kLine - kMargin;
    bar = std::clamp(room, kBarMin, kBarMax);
    height_px = (bar_top + bar + kLine + kMargin) * dot_px;
  }
  int dot_px, width_px, height_px;
  int bar_top, bar;  // dots
};

void draw_legend(Image& canvas, int left_px, const Legend& legend,
                 const std::vector<std::string>& lines) {
  const int dot = legend.dot_px;
  const int x = left_px + kMargin * dot;
  int y = kMargin * dot;
  for (const std::string& line : lines) {
    draw_text(canvas, x, y, dot, line, kInk);
    y += kLine * dot;
  }
  const int top = legend.bar_top * dot, height = legend.bar * dot;
  for (int row = 0; row < height; ++row) {
    const double place = 1 - (row + 0.5) / height;
    fill_rect(canvas, x, top + row, kBarWidth * dot, 1, error_colour(error_at(place)));
  }
  fill_rect(canvas, x, top + height, kBarWidth * dot, kLine * dot, error_colour(0));

  const auto name = [&](double error, const std::string& label) {
    const int at = top + static_cast<int>(std::lround((1 - place_of(error)) * height));
    const int tick = x + kBarWidth * dot;
    fill_rect(canvas, tick, at - dot / 2, (kBarToLabel - 2) * dot, dot, kInk);
    draw_text(canvas, tick + kBarToLabel * dot, at - kGlyphRows * dot / 2, dot, label, kInk);
  };
  for (const double error : kNamedErrors) name(error, fmt::format("{:g}", error));
  name(kLeastShownError, fmt::format("{:g}", kLeastShownError));
}

}  // namespace

glm::vec3 error_colour(double error) {
  if (error < kLeastShownError) return glm::vec3(0.0F);
  const double place = std::min(place_of(error), 1.0) * (kRamp.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  return glm::mix(kRamp[below], kRamp[below + 1],
                  static_cast<float>(place - static_cast<double>(below)));
}

Image error_map(const Image& a, const Image& b, const std::vector<std::string>& caption) {
  check_same_size(a, b);
  std::vector<std::string> lines = caption;
  lines.emplace_back("MAX 9.99e-99");  // as wide as it can become
  const Legend legend(a, lines);
  Image canvas(a.width + legend.width_px, std::max(a.height, legend.height_px));
  fill_rect(canvas, 0, 0, canvas.width, canvas.height, kPaper);
  double largest = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const double error = pixel_error(clamp_to_unit(a.at(x, y)), clamp_to_unit(b.at(x, y)));
      canvas.at(x, y) = error_colour(error);
      largest = std::max(largest, error);
    }
  }
  lines.back() = fmt::format("MAX {:.3g}", largest);
  draw_legend(canvas, a.width, legend, lines);
  return canvas;
}

}  // namespace sgs
