// Where on the screen a splat may be blended, and whether it can reach a rectangle of pixels.
//
// Two cuts. Tiles: the 16x16 tiles touched by the square of half-size `radius` (section 2.7 of the
// rendering semantics; part of the reference image). Ellipse: where alpha < 1/255 nothing is
// blended; leaving such pixels out changes no bit, so this cut must never remove a pixel whose
// *computed* alpha passes. With the conic (A, B, C) as computed, q(d) = A dx^2 + 2 B dx dy + C dy^2
// and power = -q/2. Let S(d) = A dx^2 + 2 |B dx dy| + C dy^2 and eps the unit roundoff.
//   conic: a = |u1|^2 + 0.3 and c are off by 4 eps, b by 3 eps |u1| |u2|, each quotient by eps
//     more: q is off by at most 9 eps S from the form Q of the exact u1, u2 over the computed
//     determinant, which is positive definite. The determinant, a sum of squares, is off by
//     (6 + 4 sqrt(kappa)) eps.
//   pixel: log2(e) in the conic loses 1.3 eps S, products and sums of the exponent 4 eps S, the
//     differences x - X 4 eps S (and 1e-5 absolute, for which visible_cutoff has room).
// So the computed q >= Q - 19 eps S, where 19 eps S <= 27 eps (A dx^2 + C dy^2) <= 27 eps kappa Q
// with kappa = tr^2/det of the matrix. Since 1 / (1 - 27 t) <= 1 + 35 t for t <= 1/128, an ellipse
// wider by 64 eps kappa holds every visible pixel while that is below 1/2; beyond, only the tiles
// cut.
#pragma once

#include <cmath>
#include <limits>

#include "algorithm/splat/projection.h"
#include "algorithm/splat/rects.h"

namespace sgs {

constexpr float kRoundoff = 0x1p-24F;  // half a unit in the last place of 1.0F

// Widening of q by which an ellipse of condition tr^2/det surely holds what is computed as visible;
// to be used below kMaxWidening only.
template <class T>
T ellipse_widening(T condition) {
  return T(T(64 * kRoundoff) * condition);
}
constexpr float kMaxWidening = 0.5F;

// Largest q = d^T conic d with alpha = opacity exp(-q/2) >= 1/255, with room for the rounding of
// 2^t and of the product (relative 1e-6 in alpha is 2e-6 in q). Negative: never visible.
template <class T>
T visible_cutoff(T opacity) {
  return T(T(2.0F) * log_of(T(T(255.0F) * opacity)) + T(1e-4F));
}

// Tile rectangle of section 2.7, in tiles.
template <class T>
PixelRectOf<IndexOf<T>> tile_rect(T x, T y, T radius, int width_px, int height_px) {
  const int tiles_x = (width_px + kTilePx - 1) / kTilePx;
  const int tiles_y = (height_px + kTilePx - 1) / kTilePx;
  const T tile = constant<T>(kTilePx), last = constant<T>(kTilePx - 1);
  return {truncated_index(T(T(x - radius) / tile), tiles_x),
          truncated_index(T(T(y - radius) / tile), tiles_y),
          truncated_index(T(T(x + radius + last) / tile), tiles_x),
          truncated_index(T(T(y + radius + last) / tile), tiles_y)};
}

// Sub-tiles that a splat may touch: its tiles, cut to the box around its visible ellipse.
// Empty for a splat that is never visible or off the frame.
template <class T>
FootprintOf<T> footprint(const Projected<T>& p, T opacity, int width_px, int height_px) {
  using Index = IndexOf<T>;
  using Short = typename WholeNumbers<T>::Short;
  const T cutoff = visible_cutoff(opacity);
  const PixelRectOf<Index> tiles = tile_rect(p.x, p.y, p.radius, width_px, height_px);
  if (tiles.empty() || !(cutoff >= T(0.0F))) return {};
  PixelRectOf<Index> box{tiles.x0 * kTilePx, tiles.y0 * kTilePx,
                         min_of<Index>(tiles.x1 * kTilePx, width_px),
                         min_of<Index>(tiles.y1 * kTilePx, height_px)};
  const T trace = T(p.cov_a + p.cov_c);
  const T widening = ellipse_widening(T(trace * trace / p.determinant));
  if (widening < T(kMaxWidening)) {
    // Rounding of x -+ half: below 2^-6 px while |x| < 2^18 (twice the largest frame); farther off,
    // half is at least |x| / 2 and the factor 1.0001 covers it.
    const T slack_px = T(0.02F);
    const T q = T(cutoff * T(T(1.0F) + widening));
    const T half_x = T(sqrt_of(T(q * p.cov_a)) * T(1.0001F) + slack_px);
    const T half_y = T(sqrt_of(T(q * p.cov_c)) * T(1.0001F) + slack_px);
    using std::ceil, std::floor;
    const auto low = [](T v, int high) { return truncated_index(T(ceil(v)), high); };
    const auto past = [](T v, int high) { return truncated_index(T(floor(v) + T(1.0F)), high); };
    box = intersection(box, {low(T(p.x - half_x), width_px), low(T(p.y - half_y), height_px),
                             past(T(p.x + half_x), width_px), past(T(p.y + half_y), height_px)});
    if (box.empty()) return {};
  }
  const auto down = [](Index px) { return static_cast<Short>(px / kSubtilePx); };
  const auto up = [](Index px) { return static_cast<Short>((px + (kSubtilePx - 1)) / kSubtilePx); };
  return {down(box.x0), down(box.y0), up(box.x1), up(box.y1)};
}

// Lower bound of q over all points of a rectangle of pixel centres (inclusive bounds, px).
// q is convex: its minimum is 0 inside, else on an edge that faces the centre.
template <class T>
T least_q(T x, T y, T a, T b, T c, const PixelRectOf<IndexOf<T>>& pixels) {
  const T left = T(number_of<T>(pixels.x0) - x), right = T(number_of<T>(pixels.x1 - 1) - x);
  const T top = T(number_of<T>(pixels.y0) - y), bottom = T(number_of<T>(pixels.y1 - 1) - y);
  const T zero = T(0.0F);
  if (left <= zero && right >= zero && top <= zero && bottom >= zero) return zero;
  const auto q = [&](T dx, T dy) { return T(a * dx * dx + T(2.0F) * b * dx * dy + c * dy * dy); };
  // Not std::clamp: a quotient that is no number (flat conic of an overflowing determinant) must
  // become a point of the edge, whichever.
  const auto clamp = [](T at, T low, T high) { return max_of(low, min_of(high, at)); };
  const auto on_vertical = [&](T dx) { return q(dx, clamp(T(-b * dx / c), top, bottom)); };
  const auto on_horizontal = [&](T dy) { return q(clamp(T(-b * dy / a), left, right), dy); };
  T least = T(std::numeric_limits<float>::max());
  if (left > zero) least = min_of(least, on_vertical(left));
  if (right < zero) least = min_of(least, on_vertical(right));
  if (top > zero) least = min_of(least, on_horizontal(top));
  if (bottom < zero) least = min_of(least, on_horizontal(bottom));
  return least;
}

// True if some pixel of the rectangle can have a computed alpha of 1/255 or more. Conservative:
// rounding is allowed for at the farthest corner, where S is largest. It is 19 eps S between Q and
// the pixel's q as above, and 9 eps S between Q and the conic here. Evaluating the conic here adds
// 6 eps S; the rest is for S itself.
template <class T>
bool reaches(T x, T y, T a, T b, T c, T cutoff, const PixelRectOf<IndexOf<T>>& pixels) {
  using std::abs;
  const auto distance = [](IndexOf<T> px, T centre) {
    return T(abs(T(number_of<T>(px) - centre)));
  };
  const T far_x = max_of(distance(pixels.x0, x), distance(pixels.x1 - 1, x));
  const T far_y = max_of(distance(pixels.y0, y), distance(pixels.y1 - 1, y));
  const T rounding =
      T(T(40 * kRoundoff) *
        T(a * far_x * far_x + T(2.0F) * T(abs(b)) * far_x * far_y + c * far_y * far_y));
  // Negated, so that a conic that is not a number keeps the splat.
  return !(least_q(x, y, a, b, c, pixels) > T(cutoff + rounding));
}

}  // namespace sgs
