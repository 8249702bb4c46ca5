// Rectangles and words drawn into a picture.
#pragma once

#include <string_view>

#include "algorithm/image/image.h"

namespace sgs {

// Characters are 3x5 dots, with a dot between two of them.
constexpr int kGlyphColumns = 3, kGlyphRows = 5;

// Width of `length` characters, in dots.
constexpr int text_dots(int length) { return length * (kGlyphColumns + 1) - 1; }

// Fills [x, x + width) x [y, y + height), cut to the picture.
void fill_rect(Image& image, int x, int y, int width, int height, const glm::vec3& colour);

// Draws `text` with its top left corner at (x, y), a dot as a square of dot_px. Letters are drawn
// as capitals; what is none of A-Z 0-9 . % - + < stays blank.
void draw_text(Image& image, int x, int y, int dot_px, std::string_view text,
               const glm::vec3& colour);

}  // namespace sgs
