// Rectangles on the screen and their sizes: pixels, and the 4x4 sub-tiles that footprints are
// counted in.
#pragma once

#include <algorithm>
#include <cstdint>

namespace sgs {

// Width and height in px.
struct PixelSize {
  int width = 0, height = 0;
};
constexpr PixelSize square_of(int side_px) { return {side_px, side_px}; }
inline bool operator==(const PixelSize& a, const PixelSize& b) {
  return a.width == b.width && a.height == b.height;
}

// Pixels [x0, x1) x [y0, y1).
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

inline PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// Sub-tiles [x0, x1) x [y0, y1) in units of 4 px from the frame's corner. 16 bits reach 262,140 px.
struct SubtileRect {
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x1 <= x0 || y1 <= y0; }
};

inline SubtileRect intersection(const SubtileRect& a, const SubtileRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

inline bool operator==(const SubtileRect& a, const SubtileRect& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

}  // namespace sgs
