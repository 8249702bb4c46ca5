// From photographs to a scene, a step at a time. The same bits for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/densification.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/start_cloud.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"

namespace sgs {

// Who decides where Gaussians come and go: Markov chain Monte Carlo with a fixed number in the end
// (Kheradmand et al. 2024), or the original's rules.
enum class Growth { kMcmc, kOriginal };

enum class Background { kRandom, kWhite, kBlack };

struct TrainingConfig {
  int steps = 20'000;
  std::uint64_t seed = 1;
  std::size_t most_gaussians = 100'000;
  std::size_t start_gaussians = 50'000;  // at most; of random ones just so many
  int sh_degree = 3;
  ComparisonRule comparison;
  Background background = Background::kRandom;  // where photographs are transparent
  StartConfig start;

  // Parts of all steps.
  double grow_from = 0.02, grow_to = 0.8;  // densification
  double full_size_from = 0.25;            // before it pictures are smaller
  double degrees_by = 0.15;                // SH degrees are raised evenly until here
  double first_downscale = 4;              // for the pictures of the first step
  int grow_every = 100;                    // steps

  Growth growth = Growth::kMcmc;
  double growth_factor = 1.05;  // each time, MCMC
  double noise = 5e5;           // noise of positions, times their rate, MCMC
  double opacity_share = 0.01;  // weight of the mean opacity in the loss, MCMC
  double scale_share = 0.01;    // weight of the mean scale in the loss, MCMC
  DensificationConfig densification;
  int reset_every = 3'000;  // steps, original

  LearningSchedule rates;

  // By the step, from 0.
  LearningRates rates_at(int step, double extent) const;
  int degree_at(int step) const;
  // Rises in steps of the square root of 2: 1 / downscale^2, what a step costs, grows evenly.
  double downscale_at(int step) const;
  bool grows_at(int step) const;
};

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
  double downscale_ = 0;  // downscale of the loaded photographs; 0: none yet
  GaussianCloud cloud_;
  ActivatedCloud activated_;
  Adam adam_;
  DensificationStatistics statistics_;
  CloudGradient gradient_;
  ViewOrder view_order_;
};

}  // namespace sgs
