// How a scene is trained.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/train/comparison.h"
#include "algorithm/train/densification.h"
#include "algorithm/train/start_cloud.h"
#include "algorithm/tune/learning_rates.h"

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
  double first_downscale = 4;              // of the pictures of the first step
  int grow_every = 100;                    // steps

  Growth growth = Growth::kMcmc;
  double growth_factor = 1.05;  // each time, MCMC
  double noise = 5e5;           // of positions, times their rate, MCMC
  double opacity_share = 0.01;  // of the mean opacity in the loss, MCMC
  double scale_share = 0.01;    // of the mean scale in the loss, MCMC
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

}  // namespace sgs
