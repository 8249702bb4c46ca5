// Boundary-aware fine-tuning (StreamingGS, DAC 2025): a scene that paper order shows better.
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/tuning_config.h"
#include "algorithm/train/view_order.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/boundary_penalty.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/visit_plan.h"

namespace sgs {

struct BoundaryTuningConfig : TuningConfig {
  double beta = 0.05;  // of L_CBP in the loss
  BoundaryPenaltyConfig penalty;
};

// Each step: L = L_3DGS + beta L_CBP of a photograph's view as paper order draws it, before black
// as the machines do, in their precision; everything but the centres moves.
class BoundaryTuner : public Fitting {
 public:
  // All that there is to save.
  struct State {
    int next_step = 0;
    GaussianCloud cloud;
    AdamMoments moments;
  };

  // photographs: loaded. plan: of a grid of the given scene. Both must outlive the tuner.
  BoundaryTuner(const BoundaryTuningConfig& config, const Photographs& photographs, VisitPlan& plan,
                GaussianCloud given);
  BoundaryTuner(const BoundaryTuningConfig& config, const Photographs& photographs, VisitPlan& plan,
                State state);

  FittingStep step() override;
  int next_step() const override { return next_step_; }
  int steps() const override { return config_.steps; }
  std::size_t gaussians() const override { return cloud_.size(); }
  std::string saved() const override;
  static State restored(const std::string& saved);

  const GaussianCloud& cloud() const { return cloud_; }

 private:
  const BoundaryTuningConfig config_;
  const Photographs& photographs_;
  VisitPlan& plan_;
  int next_step_ = 0;
  GaussianCloud cloud_;
  ActivatedCloud activated_;
  Adam adam_;
  ViewOrder view_order_;
  CloudGradient gradient_;
};

}  // namespace sgs
