// Activations and spherical harmonics, and their derivatives.
#include "algorithm/tune/gaussian_gradient.h"
#include "testbench/stability/exact.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

constexpr int kDegree = 3, kCoeffs = 16;

// Computed in double and rounded once, as activate() does for a file's floats.
BoundedFloat rounded_once(float value) {
  return {value, (1 + 1e-6) * u * std::abs(static_cast<double>(value)) + Single::kUnderflow};
}

RawGaussian<float> raw_with(float log_scale, float logit) {
  return {glm::vec3(0), glm::vec3(log_scale), {1, 0, 0, 0}, logit};
}

Deviation scale(double log_scale, Random& random) {
  const auto s = static_cast<float>(log_scale * random.uniform(0.9, 1));
  const Exact truth = exp(Exact(s));
  return deviation(rounded_once(activate(raw_with(s, 0)).scale.x), truth, truth);
}

Deviation opacity(double logit, Random& random) {
  const auto x = static_cast<float>(logit * random.uniform(0.9, 1));
  const Exact truth = 1 / (1 + exp(-Exact(x)));
  return deviation(rounded_once(activate(raw_with(0, x)).opacity), truth, truth);
}

Deviation rotation(double length_of_quat, Random& random) {
  RawGaussian<float> raw = raw_with(0, 0);
  Exact squares = 0;
  for (float& component : raw.quat) {
    component = static_cast<float>(length_of_quat * random.normal());
    squares += Exact(component) * component;
  }
  const Gaussian<float> g = activate(raw);
  Deviation worst;
  for (std::size_t k = 0; k < 4; ++k) {
    worst.add(deviation(rounded_once(g.quat[k]), raw.quat[k] / sqrt(squares), 1));
  }
  return worst;
}

// d sigmoid / d logit.
Deviation opacity_slope(double logit, Random& random) {
  using T = BoundedFloat;
  const auto x = static_cast<float>(logit * random.uniform(0.9, 1));
  RawGaussian<T> raw{};
  raw.quat[0] = T(1.0F);
  raw.opacity_logit = T(x);
  Gaussian<T> g{}, wanted{};
  wanted.opacity = T(1.0F);
  g.opacity = rounded_once(activate(raw_with(0, x)).opacity);
  const T computed = activation_gradient(raw, g, wanted).opacity_logit;
  const Exact e = exp(-abs(Exact(x))), truth = e / ((1 + e) * (1 + e));
  return deviation(computed, truth, truth);
}

// Coefficients of a size, seen along an offset.
struct Seen {
  glm::vec3 offset;
  std::vector<glm::vec3> coeffs;
  std::vector<ExactVector> exact_coeffs;
  Exact unit = 0.5;  // 0.5 and the sum of the largest channels' sizes
};
Seen seen(double distance, double size, Random& random) {
  Seen out;
  out.offset = glm::vec3(distance * random.direction());
  for (int k = 0; k < kCoeffs; ++k) {
    Exact largest = 0;
    glm::vec3 c;
    for (int channel = 0; channel < 3; ++channel) {
      c[channel] =
          static_cast<float>(size * random.uniform(0.5, 1) * (random.bits() % 2 == 0 ? 1 : -1));
      largest = std::max(largest, Exact(std::abs(c[channel])));
    }
    out.coeffs.push_back(c);
    out.exact_coeffs.push_back(exact(c));
    out.unit += largest;
  }
  return out;
}

template <class T>
glm::vec<3, T> given(const glm::vec3& v) {
  return {T(v.x), T(v.y), T(v.z)};
}
template <class T>
std::vector<glm::vec<3, T>> given(const std::vector<glm::vec3>& all) {
  std::vector<glm::vec<3, T>> out;
  for (const glm::vec3& v : all) out.push_back(given<T>(v));
  return out;
}

Deviation colour(double distance, double size, Random& random) {
  using T = BoundedFloat;
  const Seen s = seen(distance, size, random);
  const auto computed = sh_colour(kDegree, given<T>(s.coeffs).data(), given<T>(s.offset));
  const ExactVector truth = exact_colour(kDegree, s.exact_coeffs, exact(s.offset));
  Deviation worst;
  for (std::size_t k = 0; k < 3; ++k) {
    worst.add(deviation(computed[static_cast<int>(k)], truth[k] > 0 ? truth[k] : Exact(0), s.unit));
  }
  return worst;
}

// dL/doffset of L = sum w colour, against differences with a step of 10^-30.
Deviation colour_slope(double distance, Random& random) {
  using T = BoundedFloat;
  const Seen s = seen(distance, 0.5, random);
  const ExactVector at = exact(s.offset);
  const ExactVector here = exact_colour(kDegree, s.exact_coeffs, at);
  glm::vec3 w;
  glm::vec<3, T> drawn;
  Exact unit = 0;
  for (int k = 0; k < 3; ++k) {
    w[k] = static_cast<float>(random.normal());
    const Exact& channel = here[static_cast<std::size_t>(k)];
    drawn[k] = T(channel > 0 ? 1.0F : 0.0F);  // only the clamping matters
    unit += std::abs(w[k]) * s.unit / length(at);
  }
  glm::vec<3, T> by_coeffs[kCoeffs];
  const auto computed = colour_gradient(kDegree, given<T>(s.coeffs).data(), given<T>(s.offset),
                                        drawn, given<T>(w), by_coeffs);
  const Exact step = length(at) * Exact("1e-30");
  Deviation worst;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ExactVector ahead = at, behind = at;
    ahead[axis] += step;
    behind[axis] -= step;
    const ExactVector more = exact_colour(kDegree, s.exact_coeffs, ahead);
    const ExactVector less = exact_colour(kDegree, s.exact_coeffs, behind);
    Exact truth = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (here[k] > 0) truth += w[static_cast<int>(k)] * (more[k] - less[k]) / (2 * step);
    }
    worst.add(deviation(computed[static_cast<int>(axis)], truth, unit));
  }
  return worst;
}

}  // namespace

std::vector<Study> colour_studies() {
  const auto by_distance = [](double place, Random& r) { return colour(place, 0.5, r); };
  const auto by_size = [](double place, Random& r) { return colour(3, 3.4 * place, r); };
  const auto rounded_once = [](double place) { return place >= -80 ? 1.001 * u : INFINITY; };
  const auto slope_law = [](double place) { return std::abs(place) < 86 ? 8 * u : INFINITY; };
  const auto below = [](double end, double error) {
    return [=](double place) { return place < end ? error : INFINITY; };
  };
  const char *const in_double = "in double, rounded once", *const sh = "SH of the unit direction",
                    *const of_sum = "of 0.5 + sum |coeff|";
  return {
      {"scale = exp(s)",
       in_double,
       "float",
       "log-scale",
       "of the scale",
       {16, 8, 1, -1, -10, -40, -80, -90, -100, -110},
       scale,
       rounded_once,
       "u",
       "Below e^-87 a float has fewer digits, below e^-103 none: the axis has no thickness, which "
       "0.3 px^2 hides at any depth. From 10^7 units (e^16.1) on the reader refuses."},
      {"opacity = sigmoid(o)",
       in_double,
       "float",
       "logit",
       "of the opacity",
       {90, 30, 10, 1, -1, -10, -30, -80, -95, -110},
       opacity,
       rounded_once,
       "u",
       "As the scale; below 1/255 (logit -5.5) nothing is drawn anyway. From 17 on it is 1."},
      {"q / |q|", in_double, "float", "|q|", "of 1", decades(-18, 18), rotation, flat(1.001 * u),
       "u", "Does not break: no square of a float leaves double."},
      {"derivative of the opacity",
       "e / (1 + e)^2, e = exp(-|o|)",
       "float",
       "logit",
       "of the derivative",
       {-80, -40, -10, 1, 5, 10, 15, 20, 40, 80, 95},
       opacity_slope,
       slope_law,
       "8 u",
       "exp is clamped at e^-87: nothing moves such an opacity anyway."},
      {"colour, degree 3", sh, "float", "|p - c|", of_sum, decades(-6, 20), by_distance,
       below(1e18, 32 * u), "32 u to 10^18",
       "|p - c|^2 leaves float at 1.8 10^19; coordinates are refused from 10^18 on."},
      {"colour, degree 3", sh, "float", "coefficients", of_sum, decades(0, 38), by_size,
       below(1e37, 32 * u), "32 u to 10^37",
       "A sum of sixteen 3 10^38 is infinite; coefficients are refused from 10^18 on."},
      {"derivative of the colour by p", "by x, y, z of the direction, then tangential", "float",
       "|p - c|", "of sum |w coeff| / |p - c|", decades(-6, 20), colour_slope, below(1e18, 256 * u),
       "256 u to 10^18", "As the colour."}};
}

}  // namespace sgs
