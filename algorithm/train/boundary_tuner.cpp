#include "algorithm/train/boundary_tuner.h"

#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, BoundaryTuner::State& state) {
  archive(state.next_step, state.cloud, state.moments);
}

BoundaryTuner::BoundaryTuner(const BoundaryTuningConfig& config, const Photographs& photographs,
                             VisitPlan& plan, GaussianCloud given)
    : config_(config),
      photographs_(photographs),
      plan_(plan),
      cloud_(std::move(given)),
      activated_(activate(cloud_)),
      adam_(cloud_),
      view_order_(config.seed) {}

BoundaryTuner::BoundaryTuner(const BoundaryTuningConfig& config, const Photographs& photographs,
                             VisitPlan& plan, State state)
    : BoundaryTuner(config, photographs, plan, std::move(state.cloud)) {
  next_step_ = state.next_step;
  adam_.restore(std::move(state.moments));
}

std::string BoundaryTuner::saved() const {
  return saved_bytes(State{next_step_, cloud_, adam_.moments()});
}

BoundaryTuner::State BoundaryTuner::restored(const std::string& saved) {
  State state;
  restore_bytes(saved, state);
  return state;
}

FittingStep BoundaryTuner::step() {
  const std::size_t at = view_order_.at(next_step_, photographs_.size());
  const auto view = make_view<float>(photographs_.camera(at));
  const PaperOrderConfig& order = plan_.order();
  const GroupSequences sequences = plan_.sequences(at, view, activated_);
  const Comparison found =
      compare_with(photographs_.before(at, order.background), view, cloud_, activated_, sequences,
                   order.background, order.precision, config_.ssim_share, gradient_);
  double loss = found.loss;
  if (config_.beta > 0) {
    const BoundaryPenalty penalty =
        boundary_penalty(sequences, activated_, order.precision, config_.penalty);
    add_boundary_gradient(penalty, config_.beta, sequences, activated_, gradient_);
    loss += config_.beta * penalty.value;
  }
  check_finite(next_step_, loss, gradient_);
  adam_.step(gradient_, config_.rates_at(next_step_), cloud_);
  reactivate(cloud_, gradient_.indices, activated_);
  return {next_step_++, at, loss, found.l1, found.ssim, gradient_.size()};
}

}  // namespace sgs
