// The window and the constants of SSIM (Wang et al. 2004), as in the loss of Kerbl et al. 2023.
#pragma once

#include <array>
#include <cmath>
#include <numeric>

namespace sgs {

constexpr int kSsimRadiusPx = 5;  // 11x11 window
constexpr int kSsimTaps = 2 * kSsimRadiusPx + 1;
constexpr double kSsimSigmaPx = 1.5;
constexpr double kSsimC1 = 0.01 * 0.01;  // (0.01 L)^2 with L = 1, the range of the values
constexpr double kSsimC2 = 0.03 * 0.03;

// One side of the separable window; its sum is 1.
inline std::array<double, kSsimTaps> ssim_window() {
  std::array<double, kSsimTaps> window{};
  for (int i = 0; i < kSsimTaps; ++i) {
    const double offset = i - kSsimRadiusPx;
    window[i] = std::exp(-offset * offset / (2.0 * kSsimSigmaPx * kSsimSigmaPx));
  }
  const double sum = std::accumulate(window.begin(), window.end(), 0.0);
  for (double& weight : window) weight /= sum;
  return window;
}

}  // namespace sgs
