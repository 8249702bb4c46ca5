// The derivatives of the projection, against differences of the exact one.
#include <algorithm>

#include "algorithm/tune/gaussian_gradient.h"
#include "testbench/stability/projected_case.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

enum class Input { kMean, kScale, kQuat };

// x, y, cov_a, cov_b, cov_c.
std::array<Exact, 5> outputs(const ExactView& view, const ExactGaussian& g, const ExactVector& v) {
  const ExactSplat s = exact_project(view, g, v);
  return {s.x, s.y, s.cov_a, s.cov_b, s.cov_c};
}

// L = sum w output, the weights such that every output counts: differences with a step of 10^-40
// of the parameter's kind. The unit: sum |w d output|, the largest of the kind.
template <class T>
Deviation slopes(const ProjectedCase& c, Random& random, Input input) {
  const ExactView view = exact_view(c.camera);
  const ExactGaussian g = c.exact_gaussian();
  const ExactVector v = exact(c.v);
  const std::array<Exact, 5> here = outputs(view, g, v);
  const auto size = static_cast<double>(Exact(here[2] + here[4]));
  const double per_output[5] = {1 / std::sqrt(size), 1 / std::sqrt(size), 1 / size, 1 / size,
                                1 / size};
  float w[5];
  for (int k = 0; k < 5; ++k) w[k] = static_cast<float>(per_output[k] * random.normal());
  SplatGradient<T> by_splat{};
  by_splat.x = T(w[0]);
  by_splat.y = T(w[1]);
  by_splat.cov_a = T(w[2]);
  by_splat.cov_b = T(w[3]);
  by_splat.cov_c = T(w[4]);
  by_splat.opacity = T(0.0F);
  const Gaussian<T> computed =
      projection_gradient(bounded_view<T>(c.camera), given<T>(c.gaussian), given<T>(c.v), by_splat,
                          GradientRule::kDerivative);

  std::vector<T> values;
  std::vector<Exact> truths;
  std::vector<Exact> units;
  const auto differ = [&](const T& value, const Exact& step, const auto& move) {
    ExactGaussian g_more = g, g_less = g;
    ExactVector v_more = v, v_less = v;
    move(g_more, v_more, step);
    move(g_less, v_less, Exact(-step));
    const auto more = outputs(view, g_more, v_more), less = outputs(view, g_less, v_less);
    Exact truth = 0, unit = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      const Exact part = w[k] * (more[k] - less[k]) / (2 * step);
      truth += part;
      unit += abs(part);
    }
    values.push_back(value);
    truths.push_back(truth);
    units.push_back(unit);
  };
  const Exact tiny("1e-40");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    if (input == Input::kMean) {
      differ(computed.mean[k], v[2] * tiny, [&](ExactGaussian&, ExactVector& at, const Exact& by) {
        for (std::size_t row = 0; row < 3; ++row) at[row] += view.cam_from_world[row][axis] * by;
      });
    } else if (input == Input::kScale) {
      differ(computed.scale[k], g.scale[axis] * tiny,
             [&](ExactGaussian& at, ExactVector&, const Exact& by) { at.scale[axis] += by; });
    }
  }
  for (std::size_t k = 0; input == Input::kQuat && k < 4; ++k) {
    differ(computed.quat[k], tiny,
           [&](ExactGaussian& at, ExactVector&, const Exact& by) { at.quat[k] += by; });
  }
  const Exact largest = *std::max_element(units.begin(), units.end());
  const Exact longest = *std::max_element(g.scale.begin(), g.scale.end());
  Deviation worst;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Cov2D is quadratic in the scales: a thin axis' slope is as thin.
    const Exact unit = input == Input::kScale ? Exact(largest * g.scale[i] / longest) : largest;
    worst.add(deviation(values[i], truths[i], unit));
  }
  return worst;
}

}  // namespace

std::vector<Study> gradient_studies() {
  const auto along_condition = [](Input input, const char* formula, const char* why) {
    const auto sample = [=](double place, Random& r) {
      return slopes<BoundedFloat>(long_splat(place, r), r, input);
    };
    return Study{
        formula, "back through u1, u2", "float", "condition", "of sum |w d output|", decades(0, 20),
        sample,  flat(256 * u),         "256 u", why};
  };
  const char* const by_mean = "derivative of the projection by p";
  Study near = along_condition(Input::kMean, by_mean, "Does not break: 1 / v_z is at most 5.");
  near.axis = "distance from the near plane";
  near.places = decades(-6, 6);
  near.sample = [](double place, Random& r) {
    return slopes<BoundedFloat>(near_plane(place, r), r, Input::kMean);
  };
  return {along_condition(Input::kMean, by_mean,
                          "Does not break: Cov2D is differentiated, not its inverse."),
          near,
          along_condition(Input::kScale, "derivative of the projection by scale",
                          "Does not break: thin axes have digits of their own."),
          along_condition(Input::kQuat, "derivative of the projection by q",
                          "Does not break; each component by itself, the part along q is taken "
                          "away afterwards.")};
}

}  // namespace sgs
