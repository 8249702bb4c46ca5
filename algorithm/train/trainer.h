// From photographs to a scene, a step at a time. The same bits for any number of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/densification.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/training_config.h"
#include "algorithm/train/view_order.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"

namespace sgs {

class Trainer : public Fitting {
 public:
  using Step = FittingStep;
  // All that there is to save.
  struct State {
    int next_step = 0;
    GaussianCloud cloud;
    AdamMoments moments;
    DensificationStatistics statistics{0};
  };

  // photographs: must outlive the trainer, which loads them as it needs them. extent: of the scene,
  // world units (scene_extent()).
  Trainer(const TrainingConfig& config, Photographs& photographs, double extent,
          GaussianCloud start);
  Trainer(const TrainingConfig& config, Photographs& photographs, double extent, State state);

  Step step() override;
  int next_step() const override { return next_step_; }
  int steps() const override { return config_.steps; }
  std::size_t gaussians() const override { return cloud_.size(); }
  std::string saved() const override;
  static State restored(const std::string& saved);

  const GaussianCloud& cloud() const { return cloud_; }
  const ActivatedCloud& activated() const { return activated_; }
  State state() const { return {next_step_, cloud_, adam_.moments(), statistics_}; }

 private:
  glm::vec3 background_of(int step) const;
  void prepare(int step);
  Step descend(int step);
  void add_regularisers();
  void grow(int step);

  const TrainingConfig config_;
  Photographs& photographs_;
  const double extent_;
  int next_step_ = 0;
  double downscale_ = 0;  // of the photographs as they are loaded; 0: not yet
  GaussianCloud cloud_;
  ActivatedCloud activated_;
  Adam adam_;
  DensificationStatistics statistics_;
  CloudGradient gradient_;
  ViewOrder view_order_;
};

}  // namespace sgs
