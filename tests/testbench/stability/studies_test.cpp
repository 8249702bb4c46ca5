// Every formula: below its proven bound, below its law, and broken where it is said
// to break.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "testbench/stability/study.h"

using namespace sgs;

namespace {

constexpr int kSamples = 20;
constexpr std::uint64_t kSeed = 2;  // not the table's

std::string name_of(const Study& s) {
  return s.formula + " | " + s.form + " | " + s.arithmetic + " | " + s.axis;
}

// The largest part of the law that an error takes up, of places where the law says one.
double share_of_law(const Study& study, const std::vector<PlaceResult>& results) {
  double largest = 0;
  for (const PlaceResult& r : results) {
    const double law = study.law(r.place);
    if (std::isfinite(law)) largest = std::max(largest, r.worst.error / law);
  }
  return largest;
}

}  // namespace

TEST_CASE("stability: no error above its bound or its law, no bound far above all errors") {
  for (const Study& study : all_studies()) {
    INFO(name_of(study));
    double largest_share = 0, largest_error = 0;
    for (const PlaceResult& r : run(study, kSamples, kSeed)) {
      INFO("at " << r.place << ": error " << r.worst.error << ", bound " << r.worst.bound
                 << ", law " << study.law(r.place));
      CHECK(r.worst.share <= 1);
      CHECK(r.worst.error <= study.law(r.place));
      largest_share = std::max(largest_share, r.worst.share);
      largest_error = std::max(largest_error, r.worst.error);
    }
    CHECK(largest_share > 0.01);
    CHECK(largest_error > 0);
  }
}

TEST_CASE("stability: no row without its unit, its law and its reason") {
  for (const Study& study : all_studies()) {
    INFO(name_of(study));
    for (const std::string& text :
         {study.formula, study.form, study.arithmetic, study.axis, study.unit, study.law_text}) {
      CHECK(!text.empty());
    }
    CHECK(study.why.size() > 10);
    CHECK(study.places.size() > 4);
  }
}

TEST_CASE("stability: where each formula breaks, and how near its law it comes before") {
  struct Row {
    const char* name;
    double first, last;  // it breaks between these places; 0: nowhere
    // Half of what is measured: the largest part of the law that an error takes up. Less says that
    // less is rounded, or that the law has been widened.
    double least_share;
  };
  const std::vector<Row> rows{
      {"v = R^T (p - c) | p - c, c as two floats | float | coordinates", 0, 0, 0.079},
      {"depth key v_z | bits of v_z | float | distance from the near plane", 0, 0, 0.07},
      {"depth key v_z | bits of v_z | half | distance from the near plane", 1e5, 1e5, 0.062},
      {"v_z > 0.2 | as the key | float | distance from the near plane", 1e-6, 1e-5, 0.053},
      {"centre x = f v_x / v_z + c_x | as written | float | distance from the near plane", 0, 0,
       0.19},
      {"covariance J W Sigma W^T J^T + 0.3 I | u_i . u_k, u = rows of J W M | float | condition", 0,
       0, 0.034},
      {"determinant | 0.09 + 0.3 (|u1|^2 + |u2|^2) + |u1 x u2|^2 | float | condition", 1e12, 1e14,
       0.023},
      {"conic, the inverse | by the minors | float | condition", 1e12, 1e14, 0.008},
      {"conic, the inverse | by the minors | float | px of one sigma, discs", 1e9, 1e10, 0.0045},
      {"larger eigenvalue, of the radius | mid + sqrt(((a - c)/2)^2 + b^2) | float | part by which "
       "the axes differ",
       0, 0, 0.035},
      {"larger eigenvalue, of the radius | mid + sqrt(((a - c)/2)^2 + b^2) | float | px of one "
       "sigma, discs",
       1e9, 1e10, 0.044},
      {"footprint: half side sqrt(q a) | as written | float | condition", 0, 0, 0.016},
      {"footprint: cutoff 2 ln(255 opacity) | as written, + 10^-4 | float | 255 opacity - 1", 0, 0,
       0.084},
      {"exponent of the falloff | A dx^2 + C dy^2 + 2 B dx dy | float | condition", 1e5, 1e6,
       0.0059},
      {"exponent of the falloff | A (dx + (B/A) dy)^2 + (C - B^2/A) dy^2, along x and y in "
       "units of their own | half | condition",
       1e1, 1e3, 0.014},
      {"derivative of the falloff by the covariance | sum f e e^T / 2, e = K d | float | condition",
       1e12, 1e14, 0.0045},
      {"scale = exp(s) | in double, rounded once | float | log-scale", -110, -100, 0.48},
      {"opacity = sigmoid(o) | in double, rounded once | float | logit", -110, -95, 0.48},
      {"q / |q| | in double, rounded once | float | |q|", 0, 0, 0.24},
      {"derivative of the opacity | e / (1 + e)^2, e = exp(-|o|) | float | logit", 95, 95, 0.19},
      {"colour, degree 3 | SH of the unit direction | float | |p - c|", 1e20, 1e20, 0.011},
      {"colour, degree 3 | SH of the unit direction | float | coefficients", 1e38, 1e38, 0.01},
      {"derivative of the colour by p | by x, y, z of the direction, then tangential | float | |p "
       "- c|",
       1e20, 1e20, 0.0014},
      {"alpha = min(0.99, opacity 2^t) | table of 64 parabolas | float | opacity", 0, 0, 0.18},
      {"alpha = min(0.99, opacity 2^t) | table of 64 lines | half | opacity", 0, 0, 0.15},
      {"light behind layers of 1/255 | T - alpha T | float | layers", 22'000, 100'000, 0.019},
      {"light behind layers of 1/255 | T - alpha T | half | layers", 300, 1000, 0.051},
      {"light behind one splat | T - alpha T | float | 1 - alpha", 0, 0, 0.41},
      {"colour of a pixel, layers of 1/255 | C + c (alpha T) | float | layers", 0, 0, 0.0075},
      {"colour of a pixel, layers of 1/255 | C + c (alpha T) | half | layers", 500, 1000, 0.01},
      {"dL/dalpha | back to front: T (g c) - behind / (1 - alpha) | float | layers", 0, 0, 0.009},
      {"dL/dalpha | back to front: T (g c) - behind / (1 - alpha) | float | 1 - alpha", 0, 0, 0.18},
      {"derivative of the projection by p | back through u1, u2 | float | condition", 0, 0, 0.01},
      {"derivative of the projection by p | back through u1, u2 | float | distance from the near "
       "plane",
       0, 0, 0.0054},
      {"derivative of the projection by scale | back through u1, u2 | float | condition", 0, 0,
       0.018},
      {"derivative of the projection by q | back through u1, u2 | float | condition", 0, 0, 0.012},
  };
  const std::vector<Study> studies = all_studies();
  REQUIRE(studies.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(name_of(studies[i]) == rows[i].name);
    const std::vector<PlaceResult> results = run(studies[i], kSamples, kSeed);
    const double at = breaks_at(results);
    INFO(rows[i].name << " breaks at " << at);
    CHECK(share_of_law(studies[i], results) >= rows[i].least_share);
    if (rows[i].first == 0) {
      CHECK(std::isnan(at));
    } else {
      CHECK(at >= rows[i].first);
      CHECK(at <= rows[i].last);
    }
  }
}
