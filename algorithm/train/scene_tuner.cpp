#include "algorithm/train/scene_tuner.h"

#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, SceneTuner::State& state) {
  archive(state.next_step, state.cloud, state.moments);
}

SceneTuner::SceneTuner(const TuningConfig& config, const Photographs& photographs,
                       DrawingOrder order, Penalty penalty, GaussianCloud given)
    : config_(config),
      photographs_(photographs),
      order_(std::move(order)),
      penalty_(std::move(penalty)),
      cloud_(std::move(given)),
      activated_(activate(cloud_)),
      adam_(cloud_),
      view_order_(config.seed) {}

SceneTuner::SceneTuner(const TuningConfig& config, const Photographs& photographs,
                       DrawingOrder order, Penalty penalty, State state)
    : SceneTuner(config, photographs, std::move(order), std::move(penalty),
                 std::move(state.cloud)) {
  next_step_ = state.next_step;
  adam_.restore(std::move(state.moments));
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
  double loss =
      compare_with(photographs_.before(at, order_.background), view, cloud_, activated_, sequences,
                   order_.background, order_.precision, config_.comparison, gradient_);
  if (penalty_) loss += penalty_(view, sequences, cloud_, activated_, gradient_);
  check_finite(next_step_, loss, gradient_);
  const auto beyond = adam_.step(gradient_, config_.rates_at(next_step_), cloud_);
  reactivate(cloud_, gradient_.indices, activated_);
  check_limits(next_step_, beyond);
  return {next_step_++, at, loss};
}

}  // namespace sgs
