// Alpha, the light that is left, colour, and their derivatives.
#include "algorithm/splat/blend.h"
#include "algorithm/tune/splat_gradient.h"
#include "testbench/stability/study.h"

namespace sgs {
namespace {

template <class T>
Deviation alpha(double opacity, Random& random) {
  const T held = constant<T>(opacity);
  const T o(held.value), exponent(static_cast<float>(-random.uniform() * std::log2(255 * opacity)));
  const Exact truth = Exact(o.value) * pow(Exact(2), Exact(exponent.value));
  // Decisions are not computed: what the two thresholds do with a rounding is counted elsewhere.
  const Exact least = Exact(1) / 255, most = Exact(99) / 100;
  const Exact margin = 16 * (std::is_same_v<T, BoundedHalf> ? h : u);
  if (truth < least * (1 + margin)) return {};
  const Exact capped = truth > most ? most : truth;
  return deviation(alpha_of(exponent, exp2_of(exponent), o), capped, capped);
}

// 1/255 as the format holds it: the faintest layer that is blended.
template <class T>
T faint() {
  return T(constant<T>(kAlphaMin).value);
}

// With the bound of its own analysis: fl(T - fl(alpha T)) is off by u (1 + alpha / (1 - alpha)) of
// itself, for alpha of 1/255 by 1.004 u a layer. That T is taken twice the running bound cannot
// see.
template <class Format>
Bounded<Format> through(Bounded<Format> light, int layers) {
  const double relative = 1.01 * Format::kRoundoff * layers;
  constexpr double kAllUnderflows = 300 * Format::kUnderflow;  // each decays by 254/255 a layer
  return {light.value, relative * (1 + relative) * light.value + kAllUnderflows};
}

// The light behind so many layers of alpha 1/255; finishing is left out.
template <class T>
Deviation through_layers(double layers) {
  const T alpha = faint<T>();
  T light(1.0F);
  for (int i = 0; i < static_cast<int>(layers); ++i) {
    light = through(take_light(alpha, light).after, i + 1);
  }
  const Exact truth = pow(1 - Exact(alpha.value), static_cast<int>(layers));
  return deviation(light, truth, truth);
}
template <class T>
Deviation behind_one(double rest, Random& random) {
  const T alpha(static_cast<float>(1 - rest)), before(static_cast<float>(random.uniform(0.1, 1)));
  const Exact truth = Exact(before.value) * (1 - Exact(alpha.value));
  return deviation(take_light(alpha, before).after, truth, truth);
}

// A white pixel behind so many layers of alpha 1/255, until it is finished.
template <class T>
Deviation white(double layers) {
  const T alpha = faint<T>();
  T light(1.0F), sum(0.0F);
  int blended = 0;
  for (; blended < static_cast<int>(layers); ++blended) {
    const LightShare<T> share = take_light(alpha, light);
    if (share.after < constant<T>(kTransmittanceMin)) break;
    sum = T(sum + T(1.0F) * share.weight);
    light = through(share.after, blended + 1);
  }
  const Exact truth = 1 - pow(1 - Exact(alpha.value), blended);
  return deviation(sum, truth, 1);
}

// dL/dalpha of the first of so many layers, back to front.
Deviation first_of(double layers, Random& random) {
  using T = BoundedFloat;
  const int count = static_cast<int>(layers);
  std::vector<T> alphas, before;
  std::vector<float> toward;
  T light(1.0F);
  Exact exact_light = 1, behind = 0, unit = 0;
  std::vector<Exact> exact_before;
  for (int i = 0; i < count; ++i) {
    alphas.emplace_back(static_cast<float>(random.uniform(1, 2) / 255));
    toward.push_back(static_cast<float>(random.normal()));
    before.push_back(light);
    exact_before.push_back(exact_light);
    light = through(take_light(alphas.back(), light).after, i + 1);
    exact_light *= 1 - Exact(alphas.back().value);
  }
  T carried(0.0F), by_alpha(0.0F);
  for (int i = count; i-- > 0;) {
    const auto at = static_cast<std::size_t>(i);
    const auto share = share_gradient(alphas[at], before[at], T(toward[at]), carried, T(1.0F));
    carried = share.behind;
    by_alpha = share.falloff;
    if (i == 0) break;
    const Exact weight = Exact(alphas[at].value) * exact_before[at];
    behind += weight * toward[at];
    unit += weight * std::abs(toward[at]);
  }
  const Exact truth = toward[0] - behind / (1 - Exact(alphas[0].value));
  return deviation(by_alpha, truth, Exact(unit + std::abs(toward[0])));
}

// dL/dalpha of a splat that leaves `rest`.
Deviation slope_at(double rest, Random& random) {
  using T = BoundedFloat;
  const auto alpha = static_cast<float>(1 - rest), before = static_cast<float>(random.uniform());
  const auto toward = static_cast<float>(random.normal()),
             behind = static_cast<float>(rest * random.normal());
  const auto share = share_gradient(T(alpha), T(before), T(toward), T(behind), T(1.0F));
  const Exact front = Exact(before) * toward, back = Exact(behind) / (1 - Exact(alpha));
  return deviation(share.falloff, front - back, abs(front) + abs(back));
}

// Where nothing is random.
auto undrawn(Deviation (*f)(double)) {
  return [f](double place, Random&) { return f(place); };
}

}  // namespace

std::vector<Study> blend_studies() {
  using F = BoundedFloat;
  using H = BoundedHalf;
  const std::vector<double> opacities{1.0, 0.99, 0.9, 0.5, 0.1, 0.01, 1.001 / 255};
  const std::vector<double> layers{1, 10, 100, 300, 1000, 2345, 10'000, 22'000, 100'000};
  const std::vector<double> until_finished{1, 10, 100, 200, 300, 500, 1000, 2345, 100'000};
  const std::vector<double> rests{0.9, 0.5, 0.1, 0.05, 0.02, 0.01};
  const auto by_layers = [](double last, double roundoff) {
    return [=](double place) { return place <= last ? 1.1 * roundoff * place : INFINITY; };
  };
  const auto until_done = [](double roundoff) {
    return [=](double place) { return 2 * roundoff * std::min(place, 2400.0); };
  };
  const auto of_rest = [](double place) { return u * (1 + 1 / place); };
  const auto of_slope = [](double place) { return 8 * u + 4 * u * place; };
  const char *const alpha_is = "alpha = min(0.99, opacity 2^t)",
                    *const light = "light behind layers of 1/255",
                    *const pixel = "colour of a pixel, layers of 1/255",
                    *const back = "back to front: T (g c) - behind / (1 - alpha)";
  return {
      {alpha_is, "table of 64 parabolas", "float", "opacity", "of alpha", opacities, alpha<F>,
       flat(4 * u), "4 u", "Does not break at either end."},
      {alpha_is, "table of 64 lines", "half", "opacity", "of alpha", opacities, alpha<H>,
       flat(5 * h), "5 u",
       "Does not break: 0.2 %, a tenth of what the exponent in half is off by."},
      {light, "T - alpha T", "float", "layers", "of T", layers, undrawn(through_layers<F>),
       by_layers(10'000, u), "u layers",
       "Right until float ends at 22,000 layers; the pixel was finished at 2,345 (T < 10^-4). "
       "The product alpha T is needed for the colour.",
       false},
      {light, "T - alpha T", "half", "layers", "of T", layers, undrawn(through_layers<H>),
       by_layers(1000, h), "u layers",
       "Each layer takes some 4 last places of T, rounded: percents of T from 1,000 layers on, "
       "where T is 0.02. The pixel is finished at 2,359; below 6 10^-5, which no pixel sees, T "
       "stands still.",
       false},
      {"light behind one splat", "T - alpha T", "float", "1 - alpha", "of T", rests, behind_one<F>,
       of_rest, "u / (1 - alpha)",
       "100 u at the cap of 0.99: nothing beside the 1 % of light that is left."},
      {pixel, "C + c (alpha T)", "float", "layers", "of white", until_finished, undrawn(white<F>),
       until_done(u), "2 u layers", "Does not break: after 2,345 layers nothing is added.", false},
      {pixel, "C + c (alpha T)", "half", "layers", "of white", until_finished, undrawn(white<H>),
       until_done(h), "2 u layers",
       "What is less than half a last place of the sum (2.4 10^-4 of white from 0.5 on) is lost, "
       "and errors of T add up: 3.7 % of white once it is finished. A haze of a thousand splats "
       "wants float.",
       false},
      {"dL/dalpha",
       back,
       "float",
       "layers",
       "of sum |g c| alpha T",
       {1, 10, 100, 1000, 2345, 10'000},
       first_of,
       of_slope,
       "8 u + 4 u layers",
       "Does not break: nothing is taken away from a sum, as front to back would."},
      {"dL/dalpha", back, "float", "1 - alpha", "of the two terms", rests, slope_at, flat(4 * u),
       "4 u", "Does not break: 1 - alpha is exact from 0.5 on, and never below 0.01."}};
}

}  // namespace sgs
