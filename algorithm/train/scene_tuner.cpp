#include "algorithm/train/scene_tuner.h"

#include <array>
#include <cmath>
#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, SceneTuner::State& state) {
  archive(state.next_step, state.cloud, state.moments);
}

namespace {

// A step of a quaternion is a part of 1: it turns a short one anywhere, and a long one not at all.
// Such ones become unit quaternions, of the same rotation; what trainings write stays as it is.
GaussianCloud of_usual_lengths(GaussianCloud cloud) {
  constexpr double kShortest = 0.01, kLongest = 100;
  for (std::array<float, 4>& quat : cloud.quats) {
    const double length = std::sqrt(double{quat[0]} * quat[0] + double{quat[1]} * quat[1] +
                                    double{quat[2]} * quat[2] + double{quat[3]} * quat[3]);
    if (length >= kShortest && length <= kLongest) continue;
    for (float& part : quat) part = static_cast<float>(part / length);
  }
  return cloud;
}

}  // namespace

SceneTuner::SceneTuner(const TuningConfig& config, const Photographs& photographs,
                       DrawingOrder order, Penalty penalty, GaussianCloud given)
    : SceneTuner(config, photographs, std::move(order), std::move(penalty),
                 State{0, of_usual_lengths(std::move(given)), {}}) {}

SceneTuner::SceneTuner(const TuningConfig& config, const Photographs& photographs,
                       DrawingOrder order, Penalty penalty, State state)
    : config_(config),
      photographs_(photographs),
      order_(std::move(order)),
      penalty_(std::move(penalty)),
      next_step_(state.next_step),
      cloud_(std::move(state.cloud)),
      activated_(activate(cloud_)),
      adam_(cloud_),
      view_order_(config.seed) {
  if (!state.moments.updates.empty()) adam_.restore(std::move(state.moments));
}

std::string SceneTuner::saved() const {
  return saved_bytes(State{next_step_, cloud_, adam_.moments()});
}

SceneTuner::State SceneTuner::restored(const std::string& saved) {
  State state;
  restore_bytes(saved, state);
  return state;
}

FittingStep SceneTuner::step() {
  const std::size_t at = view_order_.at(next_step_, photographs_.size());
  const auto view = make_view<float>(photographs_.camera(at));
  const GroupSequences sequences = order_.sequences(at, view, activated_);
  double loss = compare_with(photographs_.before(at, order_.background), photographs_.counts(at),
                             view, cloud_, activated_, sequences, order_.background,
                             order_.precision, config_.comparison, gradient_);
  if (penalty_) loss += penalty_(view, sequences, cloud_, activated_, gradient_);
  check_finite(next_step_, loss, gradient_);
  const auto beyond = adam_.step(gradient_, config_.rates_at(next_step_), cloud_);
  reactivate(cloud_, gradient_.indices, activated_);
  check_limits(next_step_, beyond);
  return {next_step_++, at, loss};
}

}  // namespace sgs
