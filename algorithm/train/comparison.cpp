#include "algorithm/train/comparison.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "algorithm/train/fitting.h"
#include "algorithm/tune/photometric_loss.h"
#include "algorithm/tune/scene_gradient.h"

namespace sgs {
namespace {

bool finite(const glm::vec3& v) { return std::isfinite(v.x + v.y + v.z); }

}  // namespace

Comparison compare_with(const Image& target, const View<float>& view,
                        const GaussianCloud& parameters, const ActivatedCloud& cloud,
                        const GroupSequences& sequences, const glm::vec3& background,
                        BlendPrecision precision, double ssim_share, CloudGradient& gradient) {
  Comparison out{draw(sequences, background, precision), 0, 0, 0};
  ImageLoss loss = photometric_loss(out.picture.image, target, ssim_share);
  scene_gradient({view, parameters, cloud, sequences, out.picture, background, precision},
                 {std::move(loss.gradient), {}}, GradientRule::kDerivative, gradient);
  out.loss = loss.loss;
  out.l1 = loss.l1;
  out.ssim = loss.ssim;
  return out;
}

void check_finite(int step, double loss, const CloudGradient& gradient) {
  if (!std::isfinite(loss)) throw NotFinite(fmt::format("step {}: the loss is {}", step, loss));
  const GaussianCloud& by = gradient.parameters;
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(by.sh_degree));
  for (std::size_t r = 0; r < gradient.size(); ++r) {
    bool all = finite(by.means[r]) && finite(by.log_scales[r]) &&
               std::isfinite(by.opacity_logits[r] + by.quats[r][0] + by.quats[r][1] +
                             by.quats[r][2] + by.quats[r][3]);
    for (std::size_t k = 0; k < coeffs; ++k) all = all && finite(by.sh_coeffs[r * coeffs + k]);
    if (all) continue;
    throw NotFinite(fmt::format("step {}: a derivative of Gaussian {} is not a finite number", step,
                                gradient.indices[r]));
  }
}

}  // namespace sgs
