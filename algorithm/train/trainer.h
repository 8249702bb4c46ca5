// From photographs to a scene, a step at a time. The same bits for any number of threads.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/densification.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/training_config.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"

namespace sgs {

// A loss or a parameter is not a number any more; what() names step and Gaussian.
class NotFinite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Trainer {
 public:
  struct Step {
    int number;  // from 0
    std::size_t photograph;
    double loss, l1, ssim;
    std::size_t seen;  // Gaussians that the step moved
  };
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

  // The next one. Throws NotFinite; the cloud is then what it was before the step.
  Step step();

  int next_step() const { return next_step_; }
  bool done() const { return next_step_ >= config_.steps; }
  const GaussianCloud& cloud() const { return cloud_; }
  const ActivatedCloud& activated() const { return activated_; }
  double downscale() const { return downscale_; }
  State state() const { return {next_step_, cloud_, adam_.moments(), statistics_}; }

 private:
  std::size_t photograph_of(int step);
  glm::vec3 background_of(int step) const;
  void prepare(int step);
  Step descend(int step);
  void add_regularisers();
  void check_finite(int step, double loss) const;
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
  std::vector<std::size_t> order_;  // of the photographs, shuffled anew each time through
  int order_of_ = -1;               // which time through that is
};

}  // namespace sgs
