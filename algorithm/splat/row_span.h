// Which sub-tiles of one row a splat's visible ellipse can reach: a span for each row of sub-tiles,
// walked downward. One new edge between rows is computed a row; sub-tiles inside a span need no
// test of their own.
//
// With the conic (A, B, C), D = A C - B^2 and Q the widened cutoff, the line at dy cuts
// A dx^2 + 2 B dx dy + C dy^2 <= Q at
//   dx = -(B/A) dy -+ sqrt(Q/A - (D/A^2) dy^2).
// The right bound is concave in dy and greatest, sqrt(Q C / D), at dy = -(B/C) sqrt(Q C / D); the
// left bound is its mirror image. So over a band of dy each bound is greatest at one of the band's
// edges, or is the extreme if that lies inside the band. An edge beyond the ellipse adds nothing:
// then an extreme, or the other edge, is farther out.
//
// Rounding. A pixel whose computed alpha passes has q <= cutoff + 40 eps S (footprint.h), and
// S <= 1.5 kappa q with kappa = tr^2/det. D is off by at most kappa eps / 2 of itself, the radicand
// by (4 + 2 kappa) eps Q / A more, and kappa >= 4: a Q wider by 128 eps kappa holds both. Below a
// widening of 1/2 the products, sums and roots lose less than 1e-4 of the greatest half-width, and
// 0.02 px where |x| < 2^18 (farther off the half-width is |x| / 2 or more). Beyond it nothing is
// said: the span is the whole row.
#pragma once

#include <array>
#include <cmath>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// Bounds along x relative to the frame, px, both inclusive; none where low > high.
template <class T>
struct RowBounds {
  T low, high;
};

template <class T>
class RowSpans {
 public:
  explicit RowSpans(const SplatOf<T>& splat) : x_(splat.x), y_(splat.y) {
    const T a = splat.conic_a, b = splat.conic_b, c = splat.conic_c;
    const T determinant = T(a * c - b * b);
    const T trace = T(a + c);
    const T widening = T(T(2.0F) * ellipse_widening(T(trace * trace / determinant)));
    const T zero = T(0.0F);
    bounded_ = a > zero && determinant > zero && widening < T(kMaxWidening);
    if (!bounded_) return;
    const T cutoff = T(visible_cutoff(splat.opacity) * T(T(1.0F) + widening));
    const T per_a = T(T(1.0F) / a);
    slope_ = T(-b * per_a);
    radicand_ = T(cutoff * per_a);
    bend_ = T(T(determinant * per_a) * per_a);
    half_width_ = sqrt_of(T(cutoff * c / determinant));
    bounded_ = half_width_ < T(kEverywhere);
    right_at_ = T(-b * half_width_ / c);
    slack_px_ = T(half_width_ * T(1e-4F) + T(0.02F));
  }

  // Begins above the row that begins at pixel row y_px.
  void start(int y_px) { edge_ = edge_at(dy_at(y_px)); }

  // All that a row takes of what was computed before it; the last two of the edge above it.
  std::array<T, 10> carried() const {
    return {x_,          y_,        slope_,    radicand_,  bend_,
            half_width_, right_at_, slack_px_, edge_.left, edge_.right};
  }

  // The next row, of the pixel rows from top_px to bottom_px (exclusive): its pixels of x in the
  // bounds may be visible. Where its top lies it computes anew: hardware that has several rows
  // under way wants that before the row above has it.
  RowBounds<T> next(int top_px, int bottom_px) {
    if (!bounded_) return {-T(kEverywhere), T(kEverywhere)};
    const Edge above = edge_;
    const T top = dy_at(top_px), bottom = dy_at(bottom_px);
    edge_ = edge_at(bottom);
    const T right = farthest(above.right, edge_.right, top, bottom, right_at_);
    const T left = farthest(-above.left, -edge_.left, top, bottom, T(-right_at_));
    return {T(x_ - left - slack_px_), T(x_ + right + slack_px_)};
  }

 private:
  static constexpr float kEverywhere = 1e30F;

  struct Edge {
    T left, right;  // relative to the centre; +-kEverywhere where the line misses the ellipse
  };

  // The line half a pixel above pixel row y_px, from the centre: it bounds the pixel centres on
  // both of its sides.
  T dy_at(int y_px) const { return T(T(static_cast<float>(y_px) - 0.5F) - y_); }

  Edge edge_at(const T& dy) const {
    if (!bounded_) return {};
    const T radicand = T(radicand_ - bend_ * dy * dy);
    if (!(radicand >= T(0.0F))) return {T(kEverywhere), T(-kEverywhere)};
    const T middle = T(slope_ * dy), half = sqrt_of(radicand);
    return {T(middle - half), T(middle + half)};
  }

  // Greatest bound over the band between two edges; extreme_at: where it is half_width_.
  T farthest(T above, T below, T top, T bottom, T extreme_at) const {
    if (extreme_at >= top && extreme_at <= bottom) return half_width_;
    return max_of(above, below);
  }

  T x_, y_;
  bool bounded_ = false;
  T slope_{}, radicand_{}, bend_{}, half_width_{}, right_at_{}, slack_px_{};
  Edge edge_{};
};

}  // namespace sgs
