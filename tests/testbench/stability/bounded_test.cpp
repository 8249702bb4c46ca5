// The bounding scalar computes what units compute, and its bounds hold and are not idle.
#include "testbench/stability/bounded.h"

#include <catch2/catch.hpp>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "algorithm/tune/gaussian_gradient.h"
#include "testbench/stability/projected_case.h"

using namespace sgs;

namespace {

bool same_bits(float a, float b) {
  return __builtin_bit_cast(std::uint32_t, a) == __builtin_bit_cast(std::uint32_t, b);
}

}  // namespace

TEST_CASE("the bounding scalar gives float's bits: projection, its derivative, colour, alpha") {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const ProjectedCase c = long_splat(std::pow(10.0, i % 21), random);
    const Projected<float> plain = project(make_view<float>(c.camera), c.gaussian, c.v);
    const Projected<BoundedFloat> bounded = c.projected<BoundedFloat>();
    REQUIRE(same_bits(plain.x, bounded.x.value));
    REQUIRE(same_bits(plain.cov_a, bounded.cov_a.value));
    REQUIRE(same_bits(plain.determinant, bounded.determinant.value));
    REQUIRE(same_bits(plain.conic_b, bounded.conic_b.value));
    REQUIRE(same_bits(plain.radius, bounded.radius.value));

    SplatGradient<float> by{};
    by.cov_a = 1;
    by.cov_b = -0.5F;
    SplatGradient<BoundedFloat> by_bounded{};
    by_bounded.cov_a = BoundedFloat(by.cov_a);
    by_bounded.cov_b = BoundedFloat(by.cov_b);
    const auto slope = projection_gradient(make_view<float>(c.camera), c.gaussian, c.v, by,
                                           GradientRule::kDerivative);
    const auto slope_bounded =
        projection_gradient(bounded_view<BoundedFloat>(c.camera), given<BoundedFloat>(c.gaussian),
                            given<BoundedFloat>(c.v), by_bounded, GradientRule::kDerivative);
    REQUIRE(same_bits(slope.quat[2], slope_bounded.quat[2].value));
    REQUIRE(same_bits(slope.mean.x, slope_bounded.mean.x.value));

    glm::vec3 sh[16];
    glm::vec<3, BoundedFloat> sh_bounded[16];
    for (int k = 0; k < 16; ++k) {
      sh[k] = glm::vec3(static_cast<float>(random.normal()));
      sh_bounded[k] = given<BoundedFloat>(sh[k]);
    }
    REQUIRE(same_bits(sh_colour(3, sh, c.v).x,
                      sh_colour(3, sh_bounded, given<BoundedFloat>(c.v)).x.value));

    const float dx = static_cast<float>(random.normal()), dy = static_cast<float>(random.normal());
    const float alpha = alpha_at(plain.conic_a, plain.conic_b, plain.conic_c, 0.9F, dx, dy);
    const BoundedFloat alpha_bounded =
        alpha_at(bounded.conic_a, bounded.conic_b, bounded.conic_c, BoundedFloat(0.9F),
                 BoundedFloat(dx), BoundedFloat(dy));
    REQUIRE(same_bits(alpha, alpha_bounded.value));
  }
}

TEST_CASE("the bounding scalar gives the half's bits: the exponent, and 2 to it") {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    SplatOf<float> s{};
    s.conic_a = static_cast<float>(log_uniform(random, 1e-6, 3));
    s.conic_c = static_cast<float>(log_uniform(random, 1e-6, 3));
    s.conic_b = static_cast<float>(random.uniform(-1, 1)) * std::sqrt(s.conic_a * s.conic_c);
    SplatOf<BoundedFloat> b{};
    b.conic_a = BoundedFloat(s.conic_a);
    b.conic_b = BoundedFloat(s.conic_b);
    b.conic_c = BoundedFloat(s.conic_c);
    const auto left = static_cast<float>(random.normal() / std::sqrt(s.conic_a));
    const auto top = static_cast<float>(random.normal() / std::sqrt(s.conic_c));
    const auto plain = blend_input_in_half<HalfScalar>(square_splat(s), left, top);
    const auto bounded =
        blend_input_in_half<BoundedHalf>(square_splat(b), BoundedFloat(left), BoundedFloat(top));
    const HalfScalar exponent = log2_falloff(plain.conic, plain.left, plain.top);
    const BoundedHalf exponent_bounded = log2_falloff(bounded.conic, bounded.left, bounded.top);
    REQUIRE(same_bits(exponent.value(), exponent_bounded.value));
    REQUIRE(same_bits(exp2_of(exponent).value(), exp2_of(exponent_bounded).value));
  }
}

TEST_CASE("bounds of single operations hold and are reached to a half") {
  struct Row {
    const char* what;
    BoundedFloat (*compute)(BoundedFloat);
    Exact (*truth)(const Exact&);
    double low, high;
  };
  for (const Row& row : {
           Row{"1 / x", [](BoundedFloat x) { return BoundedFloat(1.0F) / x; },
               [](const Exact& x) { return Exact(1 / x); }, 0.1, 10},
           {"sqrt", [](BoundedFloat x) { return sqrt(x); },
            [](const Exact& x) { return Exact(sqrt(x)); }, 1e-6, 1e6},
           {"x^2 - x", [](BoundedFloat x) { return x * x - x; },
            [](const Exact& x) { return Exact(x * x - x); }, 0.5, 2},
           {"log", [](BoundedFloat x) { return log(x); },
            [](const Exact& x) { return Exact(log(x)); }, 0.1, 300},
           {"exp", [](BoundedFloat x) { return exp(x); },
            [](const Exact& x) { return Exact(exp(x)); }, -80, 80},
           {"2^x", [](BoundedFloat x) { return exp2(x); },
            [](const Exact& x) { return Exact(pow(Exact(2), x)); }, -120, 0},
           {"root of a sum", [](BoundedFloat x) { return sqrt(x + BoundedFloat(0.3F)); },
            [](const Exact& x) { return Exact(sqrt(x + Exact(0.3F))); }, 0, 1},
       }) {
    Random random(9);
    Deviation worst;
    for (int i = 0; i < 300; ++i) {
      const auto x = static_cast<float>(random.uniform(row.low, row.high));
      worst.add(deviation(row.compute(BoundedFloat(x)), row.truth(Exact(x)), 1));
    }
    INFO(row.what << ": " << worst.share);
    CHECK(worst.share <= 1);
    CHECK(worst.share > 0.25);
  }
}

TEST_CASE("what leaves the range of a format has no bound") {
  CHECK(std::isinf((BoundedFloat(3e38F) + BoundedFloat(3e38F)).error));
  CHECK(std::isinf((BoundedHalf(300.0F) * BoundedHalf(300.0F)).error));
  const BoundedFloat unsure(1e-3F, 1e-2);
  CHECK(std::isinf((BoundedFloat(1.0F) / unsure).error));
  CHECK(std::isinf((BoundedFloat(0.0F) * (BoundedFloat(1.0F) / unsure)).error));
  CHECK(BoundedHalf(0.1F).error == Approx(std::abs(0.1F - rounded_to_half(0.1F))));
  CHECK(BoundedFloat(0.1F).error == 0);
}
