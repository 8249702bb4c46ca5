// Rectangles on the screen and their sizes: pixels, and the 4x4 sub-tiles that footprints are
// counted in.
#pragma once

#include <cstdint>

#include "algorithm/splat/scalar.h"

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
template <class Index>
struct PixelRectOf {
  Index x0{}, y0{}, x1{}, y1{};
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  Index width() const { return x1 - x0; }
  Index height() const { return y1 - y0; }

  friend PixelRectOf intersection(const PixelRectOf& a, const PixelRectOf& b) {
    return {max_of(a.x0, b.x0), max_of(a.y0, b.y0), min_of(a.x1, b.x1), min_of(a.y1, b.y1)};
  }
};
using PixelRect = PixelRectOf<int>;

// Sub-tiles [x0, x1) x [y0, y1) in units of 4 px from the frame's corner. 16 bits reach 262,140 px.
template <class Short>
struct SubtileRectOf {
  Short x0{}, y0{}, x1{}, y1{};
  bool empty() const { return x1 <= x0 || y1 <= y0; }

  friend SubtileRectOf intersection(const SubtileRectOf& a, const SubtileRectOf& b) {
    return {max_of(a.x0, b.x0), max_of(a.y0, b.y0), min_of(a.x1, b.x1), min_of(a.y1, b.y1)};
  }
};
using SubtileRect = SubtileRectOf<std::uint16_t>;
// In the arithmetic of T.
template <class T>
using FootprintOf = SubtileRectOf<typename WholeNumbers<T>::Short>;

inline bool operator==(const SubtileRect& a, const SubtileRect& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

}  // namespace sgs
