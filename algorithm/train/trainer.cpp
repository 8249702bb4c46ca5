
#include "algorithm/train/trainer.h"

#include <algorithm>
#include <cmath>

#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/counter_random.h"
#include "algorithm/train/mcmc.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

LearningRates TrainingConfig::rates_at(int step, double extent) const {
  LearningSchedule schedule = rates;
  schedule.mean_steps = steps;
  return schedule.at(step, extent);
}

int TrainingConfig::degree_at(int step) const {
  const double each = std::max(1.0, degrees_by * steps / std::max(1, sh_degree));
  return std::min(sh_degree, static_cast<int>(step / each));
}

double TrainingConfig::downscale_at(int step) const {
  const double until = full_size_from * steps;
  if (step >= until) return 1;
  const double first = 1 / (first_downscale * first_downscale);
  const double share = first + (1 - first) * step / until;
  // At least as many pixels as that.
  const double halvings = std::floor(std::log2(1 / share) + 1e-9);
  return std::exp2(halvings / 2);
}

bool TrainingConfig::grows_at(int step) const {
  return step >= grow_from * steps && step <= grow_to * steps && step % grow_every == 0;
}

template <class Archive>
void serialize(Archive& archive, Trainer::State& state) {
  archive(state.next_step, state.cloud, state.moments, state.statistics);
}

namespace {

// Coefficients of higher degrees are 0.
void raise_degree(GaussianCloud& cloud, int degree) {
  GaussianCloud raised = cloud;
  raised.resize(cloud.size(), degree);
  const auto before = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  const auto now = static_cast<std::size_t>(sh_coeff_count(degree));
  raised.sh_coeffs.assign(cloud.size() * now, glm::vec3(0.0F));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::copy_n(&cloud.sh_coeffs[i * before], before, &raised.sh_coeffs[i * now]);
  }
  cloud = std::move(raised);
}

}  // namespace

Trainer::Trainer(const TrainingConfig& config, Photographs& photographs, double extent,
                 GaussianCloud start)
    : config_(config),
      photographs_(photographs),
      extent_(extent),
      cloud_(std::move(start)),
      activated_(activate(cloud_)),
      adam_(cloud_),
      statistics_(cloud_.size()),
      view_order_(config.seed) {}

Trainer::Trainer(const TrainingConfig& config, Photographs& photographs, double extent, State state)
    : Trainer(config, photographs, extent, std::move(state.cloud)) {
  next_step_ = state.next_step;
  adam_.restore(std::move(state.moments));
  statistics_ = std::move(state.statistics);
}

std::string Trainer::saved() const { return saved_bytes(state()); }

Trainer::State Trainer::restored(const std::string& saved) {
  State state;
  restore_bytes(saved, state);
  return state;
}

glm::vec3 Trainer::background_of(int step) const {
  if (!photographs_.transparent() || config_.background == Background::kBlack) return glm::vec3(0);
  if (config_.background == Background::kWhite) return glm::vec3(1);
  CounterRandom random{config_.seed, RandomUse::kBackground, static_cast<std::uint64_t>(step)};
  const double red = random.uniform(), green = random.uniform();
  return {red, green, random.uniform()};
}

void Trainer::prepare(int step) {
  if (const double wanted = config_.downscale_at(step); wanted != downscale_) {
    photographs_.load(wanted);
    downscale_ = wanted;
  }
  if (const int degree = config_.degree_at(step); degree > cloud_.sh_degree) {
    raise_degree(cloud_, degree);
    adam_.raise_degree(degree);
    activated_ = activate(cloud_);
  }
}

// The regularisers act on the Gaussians that a step sees; all others rest.
void Trainer::add_regularisers() {
  const auto count = static_cast<double>(cloud_.size());
  const auto by_opacity = static_cast<float>(config_.opacity_share / count);
  const auto by_scale = static_cast<float>(config_.scale_share / (3 * count));
  for (std::size_t r = 0; r < gradient_.size(); ++r) {
    const Gaussian<float>& g = activated_.gaussians[gradient_.indices[r]];
    gradient_.parameters.opacity_logits[r] += by_opacity * g.opacity * (1 - g.opacity);
    gradient_.parameters.log_scales[r] += by_scale * g.scale;
  }
}

Trainer::Step Trainer::descend(int step) {
  const std::size_t at = view_order_.at(step, photographs_.size());
  const auto view = make_view<float>(photographs_.camera(at));
  const glm::vec3 background = background_of(step);
  const GroupSequences sequences = reference_sequences(view, activated_);
  const double loss = compare_with(photographs_.before(at, background), photographs_.counts(at),
                                   view, cloud_, activated_, sequences, background,
                                   BlendPrecision::kSingle, config_.comparison, gradient_);
  if (config_.growth == Growth::kMcmc) add_regularisers();
  check_finite(step, loss, gradient_);

  const LearningRates rates = config_.rates_at(step, extent_);
  const auto beyond = adam_.step(gradient_, rates, cloud_);
  if (config_.growth == Growth::kMcmc) {
    const auto moved = add_position_noise(cloud_, activated_, config_.noise * rates.mean,
                                          config_.seed, static_cast<std::uint64_t>(step));
    reactivate(cloud_, moved, activated_);
  } else {
    statistics_.add(sequences, gradient_);
  }
  reactivate(cloud_, gradient_.indices, activated_);
  check_limits(step, beyond);
  return {step, at, loss};
}

void Trainer::grow(int step) {
  const auto at = static_cast<std::uint64_t>(step);
  if (config_.growth == Growth::kMcmc) {
    relocate_dead(cloud_, adam_, config_.seed, at);
    const auto wanted = std::min(config_.most_gaussians,
                                 static_cast<std::size_t>(std::ceil(
                                     config_.growth_factor * static_cast<double>(cloud_.size()))));
    if (wanted > cloud_.size()) {
      add_shares(wanted - cloud_.size(), cloud_, adam_, config_.seed, at);
    }
  } else {
    densify_and_prune(config_.densification, statistics_, extent_, step > config_.reset_every,
                      config_.most_gaussians, config_.seed, at, cloud_, adam_);
    statistics_.clear(cloud_.size());
  }
  activated_ = activate(cloud_);
}

Trainer::Step Trainer::step() {
  const int step = next_step_;
  prepare(step);
  const Step done = descend(step);
  if (config_.grows_at(step)) grow(step);
  const bool resets = config_.growth == Growth::kOriginal && step > 0 &&
                      step % config_.reset_every == 0 && step < config_.grow_to * config_.steps;
  if (resets) {
    reset_opacities(config_.densification, cloud_, adam_);
    activated_ = activate(cloud_);
  }
  ++next_step_;
  return done;
}

}  // namespace sgs
