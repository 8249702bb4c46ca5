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
//   pixel: products and sums of power lose 4 eps S, the differences x - X 4 eps S (and 1e-5
//     absolute, for which visible_cutoff has room).
// So the computed q >= Q - 17 eps S, where 17 eps S <= 24 eps (A dx^2 + C dy^2) <= 24 eps kappa Q
// with kappa = tr^2/det of the matrix. Since 1 / (1 - 24 t) <= 1 + 32 t for t <= 1/128, an ellipse
// wider by 64 eps kappa holds every visible pixel while that is below 1/2; beyond, only the tiles
// cut.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithm/splat/projection.h"
#include "algorithm/splat/rects.h"

namespace sgs {

constexpr float kRoundoff = 0x1p-24F;  // half a unit in the last place of 1.0F

// Widening of q by which an ellipse of condition tr^2/det surely holds what is computed as visible;
// to be used below kMaxWidening only.
inline float ellipse_widening(float condition) { return 64 * kRoundoff * condition; }
constexpr float kMaxWidening = 0.5F;

// Largest q = d^T conic d with alpha = opacity exp(-q/2) >= 1/255, with room for the rounding of
// exp and of the product (relative 1e-6 in alpha is 2e-6 in q). Negative: never visible.
inline float visible_cutoff(float opacity) { return 2.0F * std::log(255.0F * opacity) + 1e-4F; }

// Tile rectangle of section 2.7, in tiles.
template <class T>
PixelRect tile_rect(T x, T y, T radius, int width_px, int height_px) {
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
inline SubtileRect footprint(const Projected<float>& p, float opacity, int width_px,
                             int height_px) {
  const float cutoff = visible_cutoff(opacity);
  const PixelRect tiles = tile_rect(p.x, p.y, p.radius, width_px, height_px);
  if (tiles.empty() || !(cutoff >= 0)) return {};
  PixelRect box{tiles.x0 * kTilePx, tiles.y0 * kTilePx, std::min(tiles.x1 * kTilePx, width_px),
                std::min(tiles.y1 * kTilePx, height_px)};
  const float trace = p.cov_a + p.cov_c;
  const float widening = ellipse_widening(trace * trace / p.determinant);
  if (widening < kMaxWidening) {
    // Rounding of x -+ half: below 2^-6 px while |x| < 2^18 (twice the largest frame); farther off,
    // half is at least |x| / 2 and the factor 1.0001 covers it.
    constexpr float kSlackPx = 0.02F;
    const float q = cutoff * (1 + widening);
    const float half_x = std::sqrt(q * p.cov_a) * 1.0001F + kSlackPx;
    const float half_y = std::sqrt(q * p.cov_c) * 1.0001F + kSlackPx;
    const auto low = [](float v, int high) { return truncated_index(std::ceil(v), high); };
    const auto past = [](float v, int high) { return truncated_index(std::floor(v) + 1, high); };
    box = intersection(box, {low(p.x - half_x, width_px), low(p.y - half_y, height_px),
                             past(p.x + half_x, width_px), past(p.y + half_y, height_px)});
    if (box.empty()) return {};
  }
  const auto down = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  const auto up = [](int px) {
    return static_cast<std::uint16_t>((px + kSubtilePx - 1) / kSubtilePx);
  };
  return {down(box.x0), down(box.y0), up(box.x1), up(box.y1)};
}

// Lower bound of q over all points of a rectangle of pixel centres (inclusive bounds, px).
// q is convex: its minimum is 0 inside, else on an edge that faces the centre.
inline float least_q(float x, float y, float a, float b, float c, const PixelRect& pixels) {
  const float left = static_cast<float>(pixels.x0) - x,
              right = static_cast<float>(pixels.x1 - 1) - x;
  const float top = static_cast<float>(pixels.y0) - y,
              bottom = static_cast<float>(pixels.y1 - 1) - y;
  if (left <= 0 && right >= 0 && top <= 0 && bottom >= 0) return 0;
  const auto q = [&](float dx, float dy) { return a * dx * dx + 2 * b * dx * dy + c * dy * dy; };
  // Not std::clamp: a quotient that is no number (flat conic of an overflowing determinant) must
  // become a point of the edge, whichever.
  const auto clamp = [](float at, float low, float high) {
    return std::max(low, std::min(high, at));
  };
  const auto on_vertical = [&](float dx) { return q(dx, clamp(-b * dx / c, top, bottom)); };
  const auto on_horizontal = [&](float dy) { return q(clamp(-b * dy / a, left, right), dy); };
  float least = std::numeric_limits<float>::max();
  if (left > 0) least = std::min(least, on_vertical(left));
  if (right < 0) least = std::min(least, on_vertical(right));
  if (top > 0) least = std::min(least, on_horizontal(top));
  if (bottom < 0) least = std::min(least, on_horizontal(bottom));
  return least;
}

// Whether some pixel of the rectangle can have a computed alpha of 1/255 or more. Conservative:
// what rounding can do is given away at the farthest corner, where S is largest: 17 eps S between Q
// and the pixel's q as above, 9 eps S between Q and the conic here, 6 eps S in evaluating it here,
// the rest for S itself.
inline bool reaches(float x, float y, float a, float b, float c, float cutoff,
                    const PixelRect& pixels) {
  const float far_x = std::max(std::abs(static_cast<float>(pixels.x0) - x),
                               std::abs(static_cast<float>(pixels.x1 - 1) - x));
  const float far_y = std::max(std::abs(static_cast<float>(pixels.y0) - y),
                               std::abs(static_cast<float>(pixels.y1 - 1) - y));
  const float rounding =
      40 * kRoundoff * (a * far_x * far_x + 2 * std::abs(b) * far_x * far_y + c * far_y * far_y);
  // Negated, so that a conic that is not a number keeps the splat.
  return !(least_q(x, y, a, b, c, pixels) > cutoff + rounding);
}

}  // namespace sgs
