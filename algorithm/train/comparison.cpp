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

ImageLoss masked_loss(Image picture, Image target, const std::vector<std::uint8_t>& counts,
                      double ssim_share) {
  blacken(picture, counts);
  blacken(target, counts);
  ImageLoss loss = photometric_loss(picture, target, ssim_share);
  blacken(loss.gradient, counts);
  return loss;
}

}  // namespace

void blacken(Image& image, const std::vector<std::uint8_t>& counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) image.pixels[i] = glm::vec3(0);
  }
}

double compare_with(const Image& target, const std::vector<std::uint8_t>& counts,
                    const View<float>& view, const GaussianCloud& parameters,
                    const ActivatedCloud& cloud, const GroupSequences& sequences,
                    const glm::vec3& background, BlendPrecision precision,
                    const ComparisonRule& rule, CloudGradient& gradient) {
  const RenderResult picture = draw(sequences, background, precision);
  ImageLoss loss = counts.empty() ? photometric_loss(picture.image, target, rule.ssim_share)
                                  : masked_loss(picture.image, target, counts, rule.ssim_share);
  scene_gradient({view, parameters, cloud, sequences, picture, background, precision},
                 {std::move(loss.gradient), {}}, rule.gradients, gradient);
  return loss.loss;
}

void check_finite(int step, double loss, const CloudGradient& gradient) {
  const GaussianCloud& by = gradient.parameters;
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(by.sh_degree));
  for (std::size_t r = 0; r < gradient.size(); ++r) {
    bool all = finite(by.means[r]) && finite(by.log_scales[r]) &&
               std::isfinite(by.opacity_logits[r] + by.quats[r][0] + by.quats[r][1] +
                             by.quats[r][2] + by.quats[r][3]);
    for (std::size_t k = 0; k < coeffs; ++k) all = all && finite(by.sh_coeffs[r * coeffs + k]);
    if (all) continue;
    throw NotFinite(fmt::format("step {}: a derivative of Gaussian {} is not a finite number",
                                step + 1, gradient.indices[r]));
  }
  if (!std::isfinite(loss)) {
    throw NotFinite(
        fmt::format("step {}: the loss is {}, every derivative is finite", step + 1, loss));
  }
}

void check_limits(int step, const std::optional<std::uint32_t>& beyond) {
  if (!beyond) return;
  throw NotFinite(fmt::format(
      "step {}: Gaussian {} would get larger, farther or brighter than a scene may hold", step + 1,
      *beyond));
}

}  // namespace sgs
