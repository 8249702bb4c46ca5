// Fine-tuning of a scene that stands: in the order that a machine draws in, with what is to become
// less.
#pragma once

#include <string>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"

namespace sgs {

// Each step: L = L_3DGS + penalty, of a photograph's view as the order draws it; everything but the
// centres moves.
class SceneTuner : public Fitting {
 public:
  // All that there is to save.
  struct State {
    int next_step = 0;
    GaussianCloud cloud;
    AdamMoments moments;
  };

  // photographs: loaded; must outlive the tuner. given: in the order's storage order; of its
  // quaternions those shorter than 0.01 or longer than 100 become unit ones. penalty: may be empty.
  SceneTuner(const TuningConfig& config, const Photographs& photographs, DrawingOrder order,
             Penalty penalty, GaussianCloud given);
  SceneTuner(const TuningConfig& config, const Photographs& photographs, DrawingOrder order,
             Penalty penalty, State state);

  FittingStep step() override;
  int next_step() const override { return next_step_; }
  int steps() const override { return config_.steps; }
  std::size_t gaussians() const override { return cloud_.size(); }
  std::string saved() const override;
  static State restored(const std::string& saved);

  const GaussianCloud& cloud() const { return cloud_; }

 private:
  const TuningConfig config_;
  const Photographs& photographs_;
  const DrawingOrder order_;
  const Penalty penalty_;
  int next_step_ = 0;
  GaussianCloud cloud_;
  ActivatedCloud activated_;
  Adam adam_;
  ViewOrder view_order_;
  CloudGradient gradient_;
};

}  // namespace sgs
