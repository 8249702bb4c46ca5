// The font, and drawing dot by dot.
#include "algorithm/image/drawing.h"

#include <algorithm>
#include <cstddef>

namespace sgs {
namespace {

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
