// The exponent of a splat's falloff at a pixel, and its derivative.
#include <algorithm>

#include "algorithm/splat/blend.h"
#include "algorithm/tune/splat_gradient.h"
#include "testbench/stability/projected_case.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

constexpr double kFrame = 1e5;  // px: no pixel lies farther from a centre and is computed

// A pixel within the visible ellipse, relative to the centre, px; exact.
struct Offset {
  float x, y;
};
Offset visible_offset(const ExactSplat& e, Random& random) {
  const auto a = static_cast<double>(e.cov_a), b = static_cast<double>(e.cov_b),
             c = static_cast<double>(e.cov_c);
  const double lambda = static_cast<double>(e.lambda);
  const double lean = (a - c) / 2, root = std::hypot(lean, b);
  const double angle = lean > 0 ? std::atan2(b, lean + root) : std::atan2(root - lean, b);
  const double other = static_cast<double>(Exact(e.determinant / e.lambda));
  const double turn = random.uniform(0, 2 * M_PI), reach = random.uniform(0.1, 3.3);
  const double along =
      std::min(kFrame, std::max(-kFrame, reach * std::cos(turn) * std::sqrt(lambda)));
  const double across = reach * std::sin(turn) * std::sqrt(other);
  return {static_cast<float>(std::cos(angle) * along - std::sin(angle) * across),
          static_cast<float>(std::sin(angle) * along + std::cos(angle) * across)};
}

Exact exact_power(const ExactSplat& e, const Offset& d) {
  const Exact x(d.x), y(d.y);
  return -(e.conic_a * x * x + e.conic_c * y * y) / 2 - e.conic_b * x * y;
}

const Exact& exact_log2_e() {
  static const Exact value = 1 / log(Exact(2));
  return value;
}

// Lane 0 of a sub-tile whose first pixel this is.
template <class T, class Conic>
T in_lane(const BlendInput<T, Conic>& in) {
  return log2_falloff(in.conic, in.left, in.top);
}

template <class T>
SplatOf<T> splat_of(const Projected<T>& p) {
  SplatOf<T> s{};
  s.conic_a = p.conic_a;
  s.conic_b = p.conic_b;
  s.conic_c = p.conic_c;
  s.opacity = T(0.9F);
  s.rgb = {T(1.0F), T(1.0F), T(1.0F)};
  return s;
}

BoundedFloat quadratic(const Projected<BoundedFloat>& p, BoundedFloat dx, BoundedFloat dy) {
  return in_lane(blend_input(splat_of(p), dx, dy));
}
BoundedHalf completed_in_half(const Projected<BoundedFloat>& p, BoundedFloat dx, BoundedFloat dy) {
  return in_lane(blend_input_in_half<BoundedHalf>(square_splat(splat_of(p)), dx, dy));
}

template <class T>
Deviation exponent(double condition, Random& random,
                   T (*form)(const Projected<BoundedFloat>&, BoundedFloat, BoundedFloat)) {
  const ProjectedCase c = long_splat(condition, random);
  const ExactSplat e = c.exact_splat();
  const Offset d = visible_offset(e, random);
  const T computed = form(c.projected<BoundedFloat>(), BoundedFloat(d.x), BoundedFloat(d.y));
  return deviation(computed, Exact(exact_power(e, d) * exact_log2_e()), exact_log2_e());
}

// dL/dcov of a loss that is sum f power over pixels, by the arms e = K d: sum f e e^T / 2.
template <class T>
std::array<T, 3> by_arms(const Projected<T>& p, const std::vector<Offset>& pixels,
                         const std::vector<float>& f) {
  FalloffMoments<T> sums{T(0.0F), T(0.0F), T(0.0F), T(0.0F), T(0.0F),
                         T(0.0F), T(0.0F), T(0.0F), T(0.0F)};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto arm = conic_arm(p.conic_a, p.conic_b, p.conic_c, T(pixels[i].x), T(pixels[i].y));
    const T fx = T(T(f[i]) * arm.x), fy = T(T(f[i]) * arm.y);
    sums.xx = T(sums.xx + fx * arm.x);
    sums.xy = T(sums.xy + fx * arm.y);
    sums.yy = T(sums.yy + fy * arm.y);
  }
  const SplatGradient<T> g = splat_gradient(sums, T(1.0F));
  return {g.cov_a, g.cov_b, g.cov_c};
}

Deviation by_covariance(double condition, Random& random) {
  const ProjectedCase c = long_splat(condition, random);
  const ExactSplat e = c.exact_splat();
  std::vector<Offset> pixels;
  std::vector<float> f;
  std::array<Exact, 3> truth{0, 0, 0};
  Exact unit = 0;
  for (int i = 0; i < 16; ++i) {
    pixels.push_back(visible_offset(e, random));
    f.push_back(static_cast<float>(random.normal()));
    const Exact x(pixels.back().x), y(pixels.back().y), w(f.back());
    const Exact arm_x = e.conic_a * x + e.conic_b * y, arm_y = e.conic_b * x + e.conic_c * y;
    truth[0] += w * arm_x * arm_x / 2;
    truth[1] += w * arm_x * arm_y;
    truth[2] += w * arm_y * arm_y / 2;
    unit += abs(w) * (arm_x * arm_x + arm_y * arm_y);
  }
  const auto computed = by_arms(c.projected<BoundedFloat>(), pixels, f);
  Deviation worst;
  for (std::size_t k = 0; k < 3; ++k) worst.add(deviation(computed[k], truth[k], unit));
  return worst;
}

}  // namespace

std::vector<Study> exponent_studies() {
  const auto in_float = [](double place, Random& r) { return exponent(place, r, quadratic); };
  const auto in_half = [](double place, Random& r) {
    return exponent(place, r, completed_in_half);
  };
  const auto float_law = [](double place) { return 200 * u * (1 + place); };
  const auto half_law = [](double place) {
    return place < 1e6 ? 100 * h * (1 + std::sqrt(place)) : INFINITY;
  };
  const auto covariance_law = [](double place) {
    return place <= 1e12 ? 100 * u * (1 + std::sqrt(place)) : INFINITY;
  };
  return {
      {"exponent of the falloff", "A dx^2 + C dy^2 + 2 B dx dy", "float", "condition", "of e^power",
       decades(0, 20), in_float, float_law, "200 u condition",
       "Three large terms cancel far out on a needle: percents of alpha there from 170 px of sigma "
       "on, noise from 2,000 px on (bounded: power > 0 is skipped). It is the original's form, to "
       "which pictures are held; cut needles where it shows."},
      {"exponent of the falloff",
       "A (dx + (B/A) dy)^2 + (C - B^2/A) dy^2, along x and y in units of their own", "half",
       "condition", "of e^power", decades(0, 20), in_half, half_law,
       "100 u sqrt(condition) to 10^6",
       "5 % at a condition of 1,000, for a division a splat (B/A, in float) and 8 "
       "multiply-accumulates a sub-tile more than the three terms. A needle of 170 px of one sigma "
       "is still 37 % off at its far ends, where pictures hardly show it."},
      {"derivative of the falloff by the covariance", "sum f e e^T / 2, e = K d", "float",
       "condition", "of sum |f| |e|^2", decades(0, 20), by_covariance, covariance_law,
       "100 u sqrt(condition) to 10^12",
       "e = K d cancels along a needle, once; from 10^5 px of sigma on a needle has no slope to "
       "tune by."}};
}

}  // namespace sgs
