// The coarse test of a first half, whatever it is bounded by.
#pragma once

#include <variant>

#include "algorithm/memory/record_split.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"

namespace sgs {

// What is the same for all rectangles that one Gaussian is tested against.
using FirstHalfBound = std::variant<CoarseBound, ExtentBound>;

FirstHalfBound bound_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                                const View<float>& view);

// v_z
inline float depth_of(const FirstHalfBound& bound) {
  return std::visit([](const auto& of) { return of.depth; }, bound);
}

// false: behind the near plane, or no pixel of the rectangle can change.
inline bool touches(const FirstHalfBound& bound, const PixelRect& pixels) {
  return std::visit([&](const auto& of) { return of.in_front && touches(of, pixels); }, bound);
}

}  // namespace sgs
