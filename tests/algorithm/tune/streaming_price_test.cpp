// The price of streaming: by hand, and its derivatives against dual numbers.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/splat/activate.h"
#include "algorithm/tune/additional_losses.h"
#include "algorithm/tune/gaussian_gradient.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/splat/dual.h"
#include "tests/algorithm/tune/hard_gaussians.h"

namespace sgs::test {
namespace {

TEST_CASE("price of streaming: of what is seen the groups that a box meets") {
  Projected<double> p{};
  p.cov_a = 25;
  p.cov_c = 100;
  const double k = std::sqrt(2 * std::log(255 * 0.5) + 1e-4);
  const double paid = 0.5 / 0.55;
  struct Row {
    double opacity;
    PixelSize group, frame;
    double price;
  };
  const double x = 1 + 2 * k * 5 / 32, y = 1 + 2 * k * 10 / 64;
  for (const Row& row : {Row{0.5, {32, 64}, {640, 640}, paid * x * y},
                         {0.5, {32, 64}, {32, 640}, paid * y},
                         {0.5, {32, 64}, {32, 64}, paid},
                         {0.003, {32, 64}, {640, 640}, 0}}) {
    CHECK(streaming_price(p, row.opacity, row.group, row.frame).value == Approx(row.price));
  }
}

TEST_CASE("price of streaming: what a picture hides is priced too, and gets a row") {
  GaussianCloud cloud;
  add_ball(cloud, {0, 0, 3}, 1, 0.999, {1, 0, 0});
  add_ball(cloud, {0, 0, 3.1}, 1, 0.999, {0, 1, 0});
  add_ball(cloud, {0, 0, 9}, 0.05, 0.9, {0, 0, 1});   // behind both
  add_ball(cloud, {0, 0, -9}, 0.05, 0.9, {0, 0, 1});  // behind the camera
  const ActivatedCloud activated = activate(cloud);
  const auto view = make_view<float>(small_camera());
  CloudGradient gradient;
  gradient.resize(2, 0);
  gradient.indices = {0, 1};
  gradient.parameters.opacity_logits = {5, 7};
  for (glm::vec3& by : gradient.parameters.sh_coeffs) by = {1, 2, 3};
  CloudGradient own;
  own.resize(0, 0);
  const GroupSequences sequences = reference_sequences(view, activated);
  const double price =
      add_streaming_gradient(view, sequences, cloud, activated, {8, 4}, 2, gradient);
  CHECK(add_streaming_gradient(view, sequences, cloud, activated, {8, 4}, 2, own) == price);
  CHECK(price > 0);
  REQUIRE(gradient.indices == std::vector<std::uint32_t>{0, 1, 2});
  REQUIRE(own.indices == gradient.indices);
  for (std::size_t r = 0; r < 3; ++r) {
    const float before = r == 0 ? 5.0F : r == 1 ? 7.0F : 0.0F;
    CHECK(own.parameters.opacity_logits[r] > 0);
    CHECK(gradient.parameters.opacity_logits[r] ==
          Approx(before + own.parameters.opacity_logits[r]));
    CHECK(gradient.parameters.sh_coeffs[r] == (r < 2 ? glm::vec3(1, 2, 3) : glm::vec3(0.0F)));
  }
}

template <class T>
T price_of(const View<T>& view, const RawGaussian<T>& raw, const PixelSize& group) {
  const Gaussian<T> g = activate(raw);
  const auto p = project(view, g, to_camera(view, g.mean));
  return streaming_price(p, g.opacity, group, {view.width, view.height}).value;
}

TEST_CASE("price of streaming: its derivatives are those of dual numbers") {
  const Camera camera = small_camera();
  const auto view = make_view<double>(camera);
  const auto dual_view = make_view<Dual>(camera);
  const PixelSize group{8, 4};
  std::size_t compared = 0;
  for (const HardScene& hard : hard_scenes()) {
    if (hard.scene.sh_degree > 0) continue;
    for (const RawGaussian<double>& raw : hard.scene.raw) {
      const Gaussian<double> g = activate(raw);
      const glm::dvec3 v = to_camera(view, g.mean);
      if (!(v.z > 0.2)) continue;
      const auto price = streaming_price(project(view, g, v), g.opacity, group, {20, 12});
      const auto ours = activation_gradient(
          raw, g, projection_gradient(view, g, v, price.by_splat, GradientRule::kDerivative));
      const auto slope = [&](auto&& member) {
        RawGaussian<Dual> dual{};
        for (int k = 0; k < 3; ++k) {
          dual.mean[k] = Dual(raw.mean[k]);
          dual.log_scale[k] = Dual(raw.log_scale[k]);
        }
        for (std::size_t k = 0; k < 4; ++k) dual.quat[k] = Dual(raw.quat[k]);
        dual.opacity_logit = Dual(raw.opacity_logit);
        member(dual).slope = 1;
        return price_of(dual_view, dual, group).slope;
      };
      double largest = std::abs(ours.opacity_logit);
      for (int k = 0; k < 3; ++k) {
        largest = std::max({largest, std::abs(ours.mean[k]), std::abs(ours.log_scale[k])});
      }
      const auto check = [&](double own, double exact) {
        INFO(hard.name);
        REQUIRE(std::abs(own - exact) <= 1e-5 * std::abs(exact) + 1e-11 * largest);
        compared += exact != 0 ? 1 : 0;
      };
      for (int k = 0; k < 3; ++k) {
        check(ours.mean[k], slope([&](auto& d) -> Dual& { return d.mean[k]; }));
        check(ours.log_scale[k], slope([&](auto& d) -> Dual& { return d.log_scale[k]; }));
      }
      for (std::size_t k = 0; k < 4; ++k) {
        check(ours.quat[k], slope([&](auto& d) -> Dual& { return d.quat[k]; }));
      }
      check(ours.opacity_logit, slope([&](auto& d) -> Dual& { return d.opacity_logit; }));
    }
  }
  CHECK(compared > 300);
}

}  // namespace
}  // namespace sgs::test
