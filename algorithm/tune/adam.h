// The optimiser of the original (Kingma and Ba 2015), for the Gaussians that a step sees, and its
// learning rates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/tune/cloud_gradient.h"

namespace sgs {

// How far one step goes for each kind of parameter, as in the original, in units of each parameter.
struct LearningRates {
  double mean, log_scale, quat, opacity_logit;
  double sh_dc, sh_rest;
};

struct LearningSchedule {
  // Rates of means, as shares of the scene's extent: they fall exponentially from the first to the
  // last step, then stay.
  double mean_first = 1.6e-4, mean_last = 1.6e-6;
  int mean_steps = 30'000;
  double log_scale = 5e-3, quat = 1e-3;
  double opacity_logit = 0.05;  // 0.025 in later releases of the original
  double sh_dc = 2.5e-3, sh_rest = 1.25e-4;

  // step: from 0. extent: of the scene, world units.
  LearningRates at(int step, double extent) const;
};

// The scene's extent: 1.1 times the largest distance of a camera from the mean of their positions,
// world units (as the released code of Kerbl et al. 2023).
double scene_extent(const std::vector<Camera>& cameras);

struct AdamConfig {
  double beta1 = 0.9, beta2 = 0.999;
  double epsilon = 1e-15;
};

// The optimiser's memory of each Gaussian. Rows: mean, log_scale, quat, opacity_logit, SH
// coefficients as the cloud holds them, filled up with zeros to a whole number of vectors; first
// moments, then second.
struct AdamMoments {
  std::size_t row = 0;                 // values of a row of one moment
  std::vector<float> values;           // [N, 2, row]
  std::vector<std::uint32_t> updates;  // [N]
};

class Adam {
 public:
  explicit Adam(const GaussianCloud& cloud, const AdamConfig& config = {});

  // m = beta1 m + (1 - beta1) g, v = beta2 v + (1 - beta2) g^2,
  // p -= rate (m / (1 - beta1^n)) / (sqrt(v / (1 - beta2^n)) + epsilon),
  // for the Gaussians that gradient holds. A Gaussian that is not seen rests: its moments too. n is
  // the number of its own updates, so that one that is rarely seen, or new, is corrected as it must
  // be. A Gaussian whose parameters would leave the limits of gaussian_cloud.h stays where it is;
  // the first such is returned. The same bits whatever the number of threads. Throws
  // std::logic_error where gradient, cloud and moments are not of one degree, or cloud and moments
  // not of one size.
  std::optional<std::uint32_t> step(const CloudGradient& gradient, const LearningRates& rates,
                                    GaussianCloud& cloud);

  // After the cloud was changed: from[i] is where Gaussian i stood before, or kNew.
  static constexpr std::uint32_t kNew = 0xffffffff;
  void rearrange(const std::vector<std::uint32_t>& from);

  // After all opacities were set anew.
  void forget_opacities();

  // After the cloud's coefficients were filled up with zeros to a higher degree.
  void raise_degree(int sh_degree);

  // All that there is to save.
  const AdamMoments& moments() const { return moments_; }
  void restore(AdamMoments moments) { moments_ = std::move(moments); }

 private:
  struct Correction {
    float first, second;  // 1 / (1 - beta1^n), 1 / sqrt(1 - beta2^n)
  };

  AdamConfig config_;
  AdamMoments moments_;
  std::vector<Correction> corrections_;  // [n]
};

}  // namespace sgs
