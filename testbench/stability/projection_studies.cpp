// Covariance on the screen, its determinant, inverse and eigenvalue, the reach of a splat.
#include "algorithm/splat/footprint.h"
#include "testbench/stability/projected_case.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

using Case = ProjectedCase (*)(double, Random&);

// compute(Projected<T>) against truth(ExactSplat), of unit(ExactSplat).
template <class T, class Compute, class Truth, class UnitOf>
auto sampled(Case make, const Compute& compute, const Truth& truth, const UnitOf& unit) {
  return [=](double place, Random& random) {
    const ProjectedCase c = make(place, random);
    const ExactSplat exact = c.exact_splat();
    const Projected<T> p = c.projected<T>();
    const auto computed = compute(p);
    const auto values = truth(exact);
    Deviation worst;
    for (std::size_t k = 0; k < values.size(); ++k) {
      worst.add(deviation(computed[k], values[k], unit(exact)));
    }
    return worst;
  };
}

template <class T>
Deviation covariance(double place, Random& random) {
  const auto of_trace = [](const ExactSplat& e) { return Exact(e.cov_a + e.cov_c); };
  return sampled<T>(
      long_splat,
      [](const Projected<T>& p) {
        return std::array<T, 3>{p.cov_a, p.cov_b, p.cov_c};
      },
      [](const ExactSplat& e) {
        return std::array<Exact, 3>{e.cov_a, e.cov_b, e.cov_c};
      },
      of_trace)(place, random);
}

template <class T>
Deviation determinant(double place, Random& random) {
  return sampled<T>(
      long_splat, [](const Projected<T>& p) { return std::array<T, 1>{p.determinant}; },
      [](const ExactSplat& e) { return std::array<Exact, 1>{e.determinant}; },
      [](const ExactSplat& e) { return e.determinant; })(place, random);
}

template <class T>
Deviation conic(double place, Random& random, Case make) {
  return sampled<T>(
      make,
      [](const Projected<T>& p) {
        const T d = p.determinant;
        return std::array<T, 3>{T(p.cov_c / d), T(-p.cov_b / d), T(p.cov_a / d)};
      },
      [](const ExactSplat& e) {
        return std::array<Exact, 3>{e.conic_a, e.conic_b, e.conic_c};
      },
      [](const ExactSplat& e) { return e.conic_a > e.conic_c ? e.conic_a : e.conic_c; })(place,
                                                                                         random);
}

// The larger eigenvalue; kMinDiscriminant is the floor for splats that are round.
template <class T>
T by_lean(const Projected<T>& p) {
  const T half = T(0.5F);
  const T mid = T(half * T(p.cov_a + p.cov_c)), lean = T(half * T(p.cov_a - p.cov_c));
  return T(mid +
           sqrt_of(max_of(constant<T>(kMinDiscriminant), T(lean * lean + p.cov_b * p.cov_b))));
}
template <class T>
Deviation eigenvalue(double place, Random& random, Case make) {
  return sampled<T>(
      make, [](const Projected<T>& p) { return std::array<T, 1>{by_lean(p)}; },
      [](const ExactSplat& e) { return std::array<Exact, 1>{e.lambda}; },
      [](const ExactSplat& e) { return e.lambda; })(place, random);
}

// Half the box of the visible ellipse, before it is widened.
Deviation half_side(double place, Random& random) {
  using T = BoundedFloat;
  const auto q = T(11.0F);
  return sampled<T>(
      long_splat, [q](const Projected<T>& p) { return std::array<T, 1>{sqrt_of(T(q * p.cov_a))}; },
      [](const ExactSplat& e) { return std::array<Exact, 1>{Exact(sqrt(11 * e.cov_a))}; },
      [](const ExactSplat& e) { return Exact(sqrt(e.cov_a + e.cov_c)); })(place, random);
}

Deviation cutoff(double over_least, Random& random) {
  const auto opacity = static_cast<float>((1 + over_least * random.uniform(0.5, 1)) / 255);
  const Exact q = 2 * log(255 * Exact(opacity)) + Exact(1e-4F);
  return deviation(visible_cutoff(BoundedFloat(opacity)), q, 1);
}

}  // namespace

std::vector<Study> projection_studies() {
  using F = BoundedFloat;
  const auto of_long = [](double place, Random& r) { return conic<F>(place, r, long_splat); };
  const auto of_wide = [](double place, Random& r) { return conic<F>(place, r, wide_disc); };
  const auto of_round = [](double place, Random& r) {
    return eigenvalue<F>(place, r, nearly_round);
  };
  const auto of_disc = [](double place, Random& r) { return eigenvalue<F>(place, r, wide_disc); };
  const auto determinant_law = [](double place) { return 32 * u + 64 * u * std::sqrt(place); };
  const auto conic_law = [](double place) {
    return place <= 1e12 ? 96 * u + 64 * u * std::sqrt(place) : INFINITY;
  };
  const char *const radius = "larger eigenvalue, of the radius",
                    *const by_mid = "mid + sqrt(((a - c)/2)^2 + b^2)",
                    *const discs = "px of one sigma, discs";
  std::vector<double> differing = decades(0, -10);
  differing.front() = 0.5;
  return {
      {"covariance J W Sigma W^T J^T + 0.3 I", "u_i . u_k, u = rows of J W M", "float", "condition",
       "of its trace", decades(0, 20), covariance<F>, flat(64 * u), "64 u",
       "Does not break: scales are multiplied once, Sigma is never formed."},
      {"determinant", "0.09 + 0.3 (|u1|^2 + |u2|^2) + |u1 x u2|^2", "float", "condition",
       "of the determinant", decades(0, 20), determinant<F>, determinant_law,
       "32 u + 64 u sqrt(condition)",
       "Needles never break it (of each product only one factor is small); discs seen on edge do "
       "at 10^5 px, where u1 x u2 is the rounding of two parallel lengths. 8 products and 7 sums "
       "more than a c - b^2, for 10^6 in condition; wider discs are cut by tiles alone."},
      {"conic, the inverse", "by the minors", "float", "condition", "of its largest entry",
       decades(0, 20), of_long, conic_law, "96 u + 64 u sqrt(condition) to 10^12",
       "As the determinant, by which it is divided."},
      {"conic, the inverse", "by the minors", "float", discs, "of its largest entry",
       decades(0, 11), of_wide, flat_to(1e9, 1e3 * u), "1000 u below 10^9 px",
       "sigma^4 leaves float: the conic is 0 and the splat as opaque everywhere as at its centre, "
       "which is right to a tenth of a sigma. Scales are refused from 10^7 units on."},
      {radius, by_mid, "float", "part by which the axes differ", "of itself", differing, of_round,
       flat(64 * u), "64 u", "Does not break: nothing cancels where a splat is round."},
      {radius, by_mid, "float", discs, "of itself", decades(0, 11), of_disc, flat_to(1e9, 64 * u),
       "64 u to 10^9 px",
       "Squares of squares leave float: the radius is infinite and all tiles are touched, which "
       "they are."},
      {"footprint: half side sqrt(q a)", "as written", "float", "condition", "of sqrt(a + c)",
       decades(0, 20), half_side, flat(256 * u), "256 u",
       "Does not break; the footprint adds 10^-4 of it and 0.02 px."},
      {"footprint: cutoff 2 ln(255 opacity)", "as written, + 10^-4", "float", "255 opacity - 1",
       "of q", decades(2, -7), cutoff, flat(64 * u), "64 u",
       "Does not break: far below the 10^-4 that is added, so nothing visible is cut."}};
}

}  // namespace sgs
