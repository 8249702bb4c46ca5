// Learning rates, and the steps of the optimiser.
#include "algorithm/tune/adam.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/widest_lanes.h"

namespace sgs {

LearningRates LearningSchedule::at(int step, double extent) const {
  const double done = std::clamp(static_cast<double>(step) / mean_steps, 0.0, 1.0);
  const double mean = std::exp(std::log(mean_first) * (1 - done) + std::log(mean_last) * done);
  return {mean * extent, log_scale, quat, opacity_logit, sh_dc, sh_rest};
}

double scene_extent(const std::vector<Camera>& cameras) {
  glm::dvec3 sum(0.0);
  for (const Camera& camera : cameras) sum += camera.position;
  const glm::dvec3 mean = sum / static_cast<double>(cameras.size());
  double farthest = 0;
  for (const Camera& camera : cameras) {
    farthest = std::max(farthest, glm::distance(camera.position, mean));
  }
  return 1.1 * farthest;
}

// One Gaussian at a time: its parameters gathered to a row, the row updated as vectors, put back.

namespace {

constexpr std::size_t kVector = 16;  // values
constexpr std::size_t kMostValues = 64;
constexpr std::size_t kFirstScale = 3, kOpacity = 10;
constexpr std::size_t kFirstCoefficient = 11;  // behind mean 3, log_scale 3, quat 4, opacity_logit

// The rows of one step.
struct StepFactors {
  float beta1, beta2, epsilon;
  float first, second;  // corrections
};

// rate, gradient, p, m, v: [count], count a whole number of vectors.
SGS_WIDEST_LANES
void update_row(std::size_t count, const StepFactors& factors, const float* __restrict rate,
                const float* __restrict gradient, float* __restrict p, float* __restrict m,
                float* __restrict v) {
  const StepFactors f = factors;
  const float rest1 = 1.0F - f.beta1, rest2 = 1.0F - f.beta2;
  for (std::size_t i = 0; i < count; ++i) {
    const float g = gradient[i];
    const float first = f.beta1 * m[i] + rest1 * g;
    const float second = f.beta2 * v[i] + rest2 * (g * g);
    m[i] = first;
    v[i] = second;
    const float size = __builtin_sqrtf(second) * f.second + f.epsilon;
    p[i] -= rate[i] * (first * f.first) / size;
  }
}

// True if a scene may hold these parameters: [count], with zeros behind the last of them.
SGS_WIDEST_LANES
bool within_limits(std::size_t count, const float* __restrict p) {
  static_assert(kMaxCoordinate == kMaxCoefficient);
  int beyond = 0;
  for (std::size_t i = 0; i < count; ++i) {
    beyond |= __builtin_fabsf(p[i]) <= static_cast<float>(kMaxCoordinate) ? 0 : 1;
  }
  for (std::size_t i = kFirstScale; i < kFirstScale + 3; ++i) {
    beyond |= p[i] <= static_cast<float>(kMaxLogScale) ? 0 : 1;
  }
  return beyond == 0;
}

// Calls move(place in the row, the values, how many) for the parameters of Gaussian i.
template <class Cloud, class Move>
void for_values(Cloud& cloud, std::size_t i, const Move& move) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  move(0, &cloud.means[i].x, 3);
  move(kFirstScale, &cloud.log_scales[i].x, 3);
  move(6, cloud.quats[i].data(), 4);
  move(kOpacity, &cloud.opacity_logits[i], 1);
  move(kFirstCoefficient, &cloud.sh_coeffs[i * coeffs].x, 3 * coeffs);
}

void gather(const GaussianCloud& cloud, std::size_t i, float* row) {
  for_values(cloud, i, [&](std::size_t at, const float* values, std::size_t count) {
    std::copy_n(values, count, row + at);
  });
}

void put_back(const float* row, std::size_t i, GaussianCloud& cloud) {
  for_values(cloud, i, [&](std::size_t at, float* values, std::size_t count) {
    std::copy_n(row + at, count, values);
  });
}

// Values of a row for coefficients to this degree.
std::size_t row_of(int sh_degree) {
  const std::size_t values =
      kFirstCoefficient + 3 * static_cast<std::size_t>(sh_coeff_count(sh_degree));
  return (values + kVector - 1) / kVector * kVector;
}

void fill_rates(const LearningRates& rates, float* row) {
  const double firsts[] = {rates.mean,      rates.mean,      rates.mean,         rates.log_scale,
                           rates.log_scale, rates.log_scale, rates.quat,         rates.quat,
                           rates.quat,      rates.quat,      rates.opacity_logit};
  std::copy(std::begin(firsts), std::end(firsts), row);
  std::fill_n(row + kFirstCoefficient, 3, static_cast<float>(rates.sh_dc));
  std::fill(row + kFirstCoefficient + 3, row + kMostValues, static_cast<float>(rates.sh_rest));
}

}  // namespace

Adam::Adam(const GaussianCloud& cloud, const AdamConfig& config) : config_(config) {
  moments_.row = row_of(cloud.sh_degree);
  moments_.values.resize(cloud.size() * 2 * moments_.row);
  moments_.updates.resize(cloud.size());
}

std::optional<std::uint32_t> Adam::step(const CloudGradient& gradient, const LearningRates& rates,
                                        GaussianCloud& cloud) {
  if (gradient.parameters.sh_degree != cloud.sh_degree || row_of(cloud.sh_degree) != moments_.row ||
      cloud.size() != moments_.updates.size()) {
    throw std::logic_error("Adam: the cloud was changed, its moments were not");
  }
  std::uint32_t most = 0;
  for (const std::uint32_t i : gradient.indices) most = std::max(most, moments_.updates[i] + 1);
  for (std::size_t n = corrections_.size(); n <= most; ++n) {
    const auto steps = static_cast<double>(n);
    corrections_.push_back({static_cast<float>(1 / (1 - std::pow(config_.beta1, steps))),
                            static_cast<float>(1 / std::sqrt(1 - std::pow(config_.beta2, steps)))});
  }
  alignas(64) float rate[kMostValues];
  fill_rates(rates, rate);
  const std::size_t row = moments_.row;
  constexpr std::uint32_t kNone = 0xffffffff;
  const auto update = [&](const tbb::blocked_range<std::size_t>& range, std::uint32_t beyond) {
    alignas(64) float p[kMostValues] = {}, g[kMostValues] = {};
    for (std::size_t r = range.begin(); r != range.end(); ++r) {
      const std::size_t i = gradient.indices[r];
      gather(gradient.parameters, r, g);
      gather(cloud, i, p);
      const Correction correction = corrections_[++moments_.updates[i]];
      const StepFactors factors{
          static_cast<float>(config_.beta1), static_cast<float>(config_.beta2),
          static_cast<float>(config_.epsilon), correction.first, correction.second};
      float* const m = &moments_.values[i * 2 * row];
      update_row(row, factors, rate, g, p, m, m + row);
      if (within_limits(row, p)) {
        put_back(p, i, cloud);
      } else {
        beyond = std::min(beyond, static_cast<std::uint32_t>(i));
      }
    }
    return beyond;
  };
  const std::uint32_t beyond =
      tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, gradient.size(), 256), kNone, update,
                           [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
  return beyond == kNone ? std::nullopt : std::optional(beyond);
}

void Adam::rearrange(const std::vector<std::uint32_t>& from) {
  AdamMoments out;
  out.row = moments_.row;
  out.values.resize(from.size() * 2 * out.row);
  out.updates.resize(from.size());
  for (std::size_t i = 0; i != from.size(); ++i) {
    if (from[i] == kNew) continue;
    const std::size_t before = from[i];
    std::copy_n(&moments_.values[before * 2 * out.row], 2 * out.row, &out.values[i * 2 * out.row]);
    out.updates[i] = moments_.updates[from[i]];
  }
  moments_ = std::move(out);
}

void Adam::forget_opacities() {
  for (std::size_t i = 0; i != 2 * moments_.updates.size(); ++i) {
    moments_.values[i * moments_.row + kOpacity] = 0;
  }
}

void Adam::raise_degree(int sh_degree) {
  const std::size_t before = moments_.row, row = row_of(sh_degree);
  std::vector<float> values(moments_.updates.size() * 2 * row);
  for (std::size_t i = 0; i != 2 * moments_.updates.size(); ++i) {
    std::copy_n(&moments_.values[i * before], before, &values[i * row]);
  }
  moments_.row = row;
  moments_.values = std::move(values);
}

}  // namespace sgs
