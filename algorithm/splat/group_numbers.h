// Numbers of a pixel group that all its items are tested with, made once a group: its pixels out of
// its place, the centres of its outer pixels, and their distances from the view's middle.
#pragma once

#include "algorithm/splat/rects.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// A group's first pixel.
template <class Index>
struct GroupPlaceOf {
  Index x{}, y{};
};

// Its pixels, cut to the frame.
template <class Index>
PixelRectOf<Index> group_at(const GroupPlaceOf<Index>& place, const PixelSize& group,
                            const PixelSize& frame) {
  return {place.x, place.y, min_of<Index>(place.x + group.width, frame.width),
          min_of<Index>(place.y + group.height, frame.height)};
}

// The next group, row by row; behind the last one it lies below the frame.
template <class Index>
GroupPlaceOf<Index> group_behind(const GroupPlaceOf<Index>& place, const PixelSize& group,
                                 const PixelSize& frame) {
  const Index right = place.x + group.width, below = place.y + group.height;
  if (right < frame.width) return {right, place.y};
  return {Index(0), below};
}

// One number for each side of a group.
template <class T>
struct GroupSides {
  T left, right, top, bottom;  // px
};

// Centres of its first and last columns and rows.
template <class T>
GroupSides<T> outer_pixels(const PixelRectOf<IndexOf<T>>& pixels) {
  return {number_of<T>(pixels.x0), number_of<T>(pixels.x1 - 1), number_of<T>(pixels.y0),
          number_of<T>(pixels.y1 - 1)};
}

// The same as distances from the view's middle, outward.
template <class T>
GroupSides<T> from_middle(const GroupSides<T>& outer, T centre_x, T centre_y) {
  return {T(centre_x - outer.left), T(outer.right - centre_x), T(centre_y - outer.top),
          T(outer.bottom - centre_y)};
}

}  // namespace sgs
