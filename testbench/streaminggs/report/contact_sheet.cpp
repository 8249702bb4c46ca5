#include "testbench/streaminggs/report/contact_sheet.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "algorithm/image/image.h"

namespace sgs {
namespace {

constexpr int kMostWidthPx = 320, kColumns = 6, kGapPx = 8, kDotPx = 2;
constexpr int kLinePx = (kGlyphRows + 4) * kDotPx;
const glm::vec3 kPaper(0.1F), kInk(0.9F);

// Each pixel the mean of those that it stands for, clamped as the eye sees them.
Image reduced(const Image& picture) {
  const int factor = (picture.width + kMostWidthPx - 1) / kMostWidthPx;
  Image out(std::max(1, picture.width / factor), std::max(1, picture.height / factor));
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      glm::vec3 sum(0);
      int count = 0;
      for (int v = y * factor; v < std::min((y + 1) * factor, picture.height); ++v) {
        for (int u = x * factor; u < std::min((x + 1) * factor, picture.width); ++u, ++count) {
          sum += glm::clamp(picture.at(u, v), 0.0F, 1.0F);
        }
      }
      out.at(x, y) = sum / static_cast<float>(count);
    }
  }
  return out;
}

}  // namespace

ContactSheet::ContactSheet(std::size_t frames) {
  const std::size_t tiles = std::min(frames, kMostTiles);
  for (std::size_t i = 0; i < tiles; ++i) shown_.push_back(i * frames / tiles);
}

bool ContactSheet::shows(std::size_t frame) const {
  return std::binary_search(shown_.begin(), shown_.end(), frame);
}

void ContactSheet::add(const Image& picture, std::string line) {
  tiles_.push_back({reduced(picture), std::move(line)});
}

Image ContactSheet::sheet() const {
  int width = 0, height = 0;
  for (const Tile& tile : tiles_) {
    const int text = text_dots(static_cast<int>(tile.line.size())) * kDotPx;
    width = std::max({width, tile.picture.width, text});
    height = std::max(height, tile.picture.height);
  }
  const int count = static_cast<int>(tiles_.size());
  const int columns = std::min(count, kColumns), rows = (count + columns - 1) / columns;
  const int step_x = width + kGapPx, step_y = height + kLinePx + kGapPx;
  Image out(columns * step_x + kGapPx, rows * step_y + kGapPx);
  fill_rect(out, 0, 0, out.width, out.height, kPaper);
  for (int i = 0; i < count; ++i) {
    const Tile& tile = tiles_[static_cast<std::size_t>(i)];
    const int left = kGapPx + i % columns * step_x, top = kGapPx + i / columns * step_y;
    for (int y = 0; y < tile.picture.height; ++y) {
      for (int x = 0; x < tile.picture.width; ++x) {
        out.at(left + x, top + y) = tile.picture.at(x, y);
      }
    }
    draw_text(out, left, top + height + 2 * kDotPx, kDotPx, tile.line, kInk);
  }
  return out;
}

}  // namespace sgs
