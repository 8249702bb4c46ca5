// The derivatives of algorithm/tune against dual numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>

#include "tests/algorithm/splat/dual.h"
#include "tests/algorithm/tune/hard_gaussians.h"

namespace sgs::test {
namespace {

struct NamedOrder {
  const char* name;
  Sequence sequence;
};
std::vector<NamedOrder> orders() { return {{"by depth", by_depth}, {"by visits", by_visits}}; }

std::vector<double> parameters(SceneOf<double> scene, std::size_t i) {
  std::vector<double> out;
  for_parameters(
      i, [&](double& p) { out.push_back(p); }, scene);
  return out;
}

// `scene` with parameter p of Gaussian i changed by change(its value).
template <class T, class Change>
SceneOf<T> changed(const SceneOf<double>& scene, std::size_t i, std::size_t p,
                   const Change& change) {
  auto out = converted<T>(scene);
  std::size_t at = 0;
  for_parameters(
      i,
      [&](T& value) {
        if (at++ == p) value = change(value);
      },
      out);
  return out;
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

// Among the parameters of its kind: what is far less than these may be rounding. Of a quaternion
// among all: a ball's has no derivative.
double largest_beside(const std::vector<double>& values, std::size_t p) {
  constexpr std::size_t kinds[] = {0, 3, 6, 10, 11};  // mean, log_scale, quaternion, opacity, SH
  if (p >= kinds[2] && p < kinds[3]) return largest(values);
  std::size_t kind = 0;
  while (kind + 1 < std::size(kinds) && kinds[kind + 1] <= p) ++kind;
  const std::size_t end = kind + 1 < std::size(kinds) ? kinds[kind + 1] : values.size();
  const auto first = values.begin();
  return largest(
      {first + static_cast<std::ptrdiff_t>(kinds[kind]), first + static_cast<std::ptrdiff_t>(end)});
}

TEST_CASE("gradients are those that dual numbers carry, for every parameter") {
  const Camera camera = small_camera();
  const auto view = make_view<double>(camera);
  const auto dual_view = make_view<Dual>(camera);
  std::size_t compared = 0;
  for (const HardScene& hard : hard_scenes()) {
    for (const NamedOrder& order : orders()) {
      const auto gradient = gradient_of(view, hard.scene, hard.loss, order.sequence);
      double of_scene = 0;
      for (std::size_t i = 0; i < hard.scene.raw.size(); ++i) {
        const std::vector<double> ours = parameters(gradient, i);
        of_scene = std::max(of_scene, largest(ours));
        for (std::size_t p = 0; p < ours.size(); ++p) {
          const auto scene =
              changed<Dual>(hard.scene, i, p, [](Dual v) { return Dual(v.value, 1); });
          const double dual = loss_of(dual_view, scene, hard.loss, order.sequence).slope;
          INFO(hard.name << ", " << order.name << ", Gaussian " << i << ", parameter " << p);
          REQUIRE(std::abs(ours[p] - dual) <=
                  1e-5 * std::abs(dual) + 1e-11 * largest_beside(ours, p));
          compared += dual != 0 ? 1 : 0;
        }
      }
      INFO(hard.name);
      REQUIRE(of_scene > 0.001);
    }
  }
  REQUIRE(compared > 20000);
}

// The original hands the gradient on through the cap, and holds u where it is clamped: away from
// both the two rules are one.
TEST_CASE("the original's gradients differ where alpha is capped and where u or w is clamped") {
  const auto view = make_view<double>(small_camera());
  for (const HardScene& hard : hard_scenes()) {
    const auto right = gradient_of(view, hard.scene, hard.loss, by_depth);
    const auto original =
        gradient_of<GradientRule::kOriginal>(view, hard.scene, hard.loss, by_depth);
    double difference = 0, scale = 0;
    for (std::size_t i = 0; i < hard.scene.raw.size(); ++i) {
      const auto a = parameters(right, i), b = parameters(original, i);
      for (std::size_t p = 0; p < a.size(); ++p) {
        difference = std::max(difference, std::abs(a[p] - b[p]));
        scale = std::max(scale, std::abs(a[p]));
      }
    }
    const auto is = [&](const char* kind) { return hard.name.rfind(kind, 0) == 0; };
    INFO(hard.name);
    if (is("capped") || is("clamped")) {
      CHECK(difference > 1e-3 * scale);
    } else if (is("hardly visible") || is("as they come")) {
      CHECK(difference <= 1e-12 * scale);
    }
  }
}

// dL/dmean by way of the covariance as the released code writes it (computeCov2DCUDA of its
// backward pass), the camera's axes being the world's.
glm::dvec3 original_mean_gradient(const View<double>& view, const Gaussian<double>& g,
                                  const SplatGradient<double>& by) {
  const double ratio_x = g.mean.x / g.mean.z, ratio_y = g.mean.y / g.mean.z;
  const double clamped_x = std::min(view.limit_x, std::max(-view.limit_x, ratio_x));
  const double clamped_y = std::min(view.limit_y, std::max(-view.limit_y, ratio_y));
  const glm::dvec3 t{clamped_x * g.mean.z, clamped_y * g.mean.z, g.mean.z};
  const double hx = view.focal_x, hy = view.focal_y;
  const double tz = 1 / t.z, tz2 = tz * tz, tz3 = tz2 * tz;
  const double j[2][3] = {{hx * tz, 0, -hx * t.x * tz2}, {0, hy * tz, -hy * t.y * tz2}};
  double rows[3][3], sigma[3][3] = {};
  rotation_rows(g.quat, rows);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) {
        sigma[r][c] += rows[r][k] * rows[c][k] * g.scale[k] * g.scale[k];
      }
    }
  }
  const double by_cov[2][2] = {{by.cov_a, by.cov_b / 2}, {by.cov_b / 2, by.cov_c}};
  double by_j[2][3] = {};
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 3; ++l) by_j[r][c] += 2 * by_cov[r][k] * j[k][l] * sigma[l][c];
      }
    }
  }
  return {clamped_x == ratio_x ? -hx * tz2 * by_j[0][2] : 0,
          clamped_y == ratio_y ? -hy * tz2 * by_j[1][2] : 0,
          -hx * tz2 * by_j[0][0] - hy * tz2 * by_j[1][1] + 2 * hx * t.x * tz3 * by_j[0][2] +
              2 * hy * t.y * tz3 * by_j[1][2]};
}

TEST_CASE("the original's gradient of a covariance is what its code computes") {
  const auto view = make_view<double>(small_camera());
  HardGaussians random(77, 0);
  std::size_t clamped = 0;
  for (int i = 0; i < 200; ++i) {
    RawGaussian<double>& raw = random.add();
    raw.mean.x *= random.uniform(0.5, 3);
    raw.mean.y *= random.uniform(0.5, 3);
    const Gaussian<double> g = activate(raw);
    SplatGradient<double> by;
    by.cov_a = random.normal();
    by.cov_b = random.normal();
    by.cov_c = random.normal();
    clamped +=
        std::abs(g.mean.x / g.mean.z) > view.limit_x || std::abs(g.mean.y / g.mean.z) > view.limit_y
            ? 1
            : 0;
    const auto ours = projection_gradient(view, g, g.mean, by, GradientRule::kOriginal).mean;
    const glm::dvec3 theirs = original_mean_gradient(view, g, by);
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::abs(ours[k] - theirs[k]) <= 1e-10 * glm::length(theirs));
    }
  }
  REQUIRE(clamped > 50);
}

}  // namespace
}  // namespace sgs::test
