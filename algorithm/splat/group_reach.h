// Which 4x4 sub-tiles of a pixel group something may change, from what a coarse filter knows of a
// Gaussian. Where all of them are finished it need not be looked at any more.
//
// A splat is blended no farther from its centre than slack + the root of reach_squared along either
// axis (extent_bound.h), so the pixel centres p it changes have x - r <= p <= x + r. Rounding: r is
// too large by 2^-9 of itself (root_above), the slack by 0.03 px; x -+ r loses half a unit in the
// last place, 2^-7 px where |x| < 2^18, and farther off, where r > 2^17, less than 2^-9 r.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/rects.h"

namespace sgs {

// Sub-tiles [x0, x1] x [y0, y1] relative to the group's corner: 4 B, for groups of up to 1024 px.
// The default is all of them.
struct GroupReach {
  std::uint8_t x0 = 0, y0 = 0, x1 = 255, y1 = 255;
};
static_assert(sizeof(GroupReach) == 4);
constexpr int kMostReachPx = 256 * 4;

// 1 / sqrt(x), 2^-9 to 2^-6.8 of itself too large: what a table with an entry for each parity of
// the exponent and seven bits of the mantissa gives. x: positive and finite.
inline float inverse_root_above(float x) {
  constexpr std::uint32_t kKept = 0xffff0000U;
  const auto floor_of_x = __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, x) & kKept);
  return (1.0F + 0x1p-9F) / std::sqrt(floor_of_x);
}

// No less than sqrt(x) (1 + 2^-9), x >= 1: a look-up and a product.
template <class T>
T root_above(T x) {
  if (!(value_of(x) < std::numeric_limits<float>::max())) return x;
  return T(x * inverse_root_above(x));
}

// The column (or row) of a pixel column of the group, as hardware has it once the position is
// whole.
template <class T>
std::uint8_t subtile_of(T px, int begin_px) {
  return static_cast<std::uint8_t>((static_cast<int>(value_of(px)) - begin_px) / kSubtilePx);
}

// Of a bound that touches the group.
template <class T>
GroupReach group_reach(const ExtentBoundOf<T>& bound, const PixelRect& group) {
  using std::ceil, std::floor;
  const auto along = [&](T at, T reach_squared, int begin, int end) {
    const T reach = T(bound.slack_px + root_above(reach_squared));
    // What is not a number leaves the group's own edge.
    const T first = max_of(T(static_cast<float>(begin)), T(ceil(T(at - reach))));
    const T last = min_of(T(static_cast<float>(end - 1)), T(floor(T(at + reach))));
    return std::array<std::uint8_t, 2>{subtile_of(first, begin), subtile_of(last, begin)};
  };
  const auto [x0, x1] = along(bound.x, bound.reach_squared_x, group.x0, group.x1);
  const auto [y0, y1] = along(bound.y, bound.reach_squared_y, group.y0, group.y1);
  return {x0, y0, x1, y1};
}

}  // namespace sgs
