// The optimiser of the original (Kingma and Ba 2015), for the Gaussians that a step sees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/learning_rates.h"

namespace sgs {

struct AdamConfig {
  double beta1 = 0.9, beta2 = 0.999;
  double epsilon = 1e-15;
};

// What the optimiser remembers of each Gaussian. Rows: mean, log_scale, quat, opacity_logit, SH
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
  // for the Gaussians that gradient holds. What is not seen rests: its moments too, and n is the
  // number of its own updates, so that one that is rarely seen, or new, is corrected as it must be.
  // A Gaussian whose parameters would leave the limits of gaussian_limits.h stays where it is; the
  // first such is returned. The same bits whatever the number of threads. Throws std::logic_error
  // where gradient, cloud and moments are not of one degree, or cloud and moments not of one size.
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
