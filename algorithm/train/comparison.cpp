#include "algorithm/train/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/train/fitting.h"
#include "algorithm/tune/group_sequences.h"
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

Quality quality_of(const Image& picture, const Image& target,
                   const std::vector<std::uint8_t>& counts) {
  if (counts.empty()) return {psnr_db(picture, target), ssim(picture, target)};
  Image own = picture, other = target;
  blacken(own, counts);
  blacken(other, counts);
  const double share = static_cast<double>(std::count(counts.begin(), counts.end(), 1)) /
                       static_cast<double>(counts.size());
  return {psnr_db(own, other) + 10 * std::log10(share), 1 - (1 - ssim(own, other)) / share};
}

std::vector<Quality> qualities(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background, const PictureSeen& seen) {
  std::vector<Quality> out;
  for (std::size_t at = 0; at < photographs.size(); ++at) {
    const auto view = make_view<float>(photographs.camera(at));
    const Image picture = draw(reference_sequences(view, cloud), background).image;
    const Image target = photographs.before(at, background);
    if (seen) seen(at, picture);
    out.push_back(quality_of(picture, target, photographs.counts(at)));
  }
  return out;
}

Quality mean_quality(const std::vector<Quality>& each) {
  Quality sum{0, 0};
  for (const Quality& one : each) {
    sum.psnr_db += one.psnr_db;
    sum.ssim += one.ssim;
  }
  const auto count = static_cast<double>(each.size());
  return {sum.psnr_db / count, sum.ssim / count};
}

PaperQuality paper_quality(const ActivatedCloud& cloud, const VoxelGrid& grid,
                           const PaperOrderConfig& order, const BoundaryPenaltyConfig& penalty,
                           const Photographs& photographs, const PictureSeen& seen) {
  std::vector<Quality> paper;
  std::uint64_t rendered = 0, misordered = 0, blends = 0, misordered_blends = 0;
  double penalties = 0;
  for (std::size_t at = 0; at < photographs.size(); ++at) {
    const auto view = make_view<float>(photographs.camera(at));
    const StreamingResult result = render_paper_order(view, cloud, grid, order);
    if (seen) seen(at, result.frame.image);
    const Image target = photographs.before(at, order.background);
    paper.push_back(quality_of(result.frame.image, target, photographs.counts(at)));
    blends += result.stats.contributors;
    misordered_blends += result.stats.misordered;
    const BoundaryPenalty found =
        boundary_penalty(visited_sequences(view, cloud, grid, result.group_voxels, order.group,
                                           order.visit_gaussians),
                         cloud, order.precision, penalty);
    rendered += found.rendered;
    misordered += found.misordered;
    penalties += found.value;
  }
  const auto share = [](std::uint64_t part, std::uint64_t all) {
    return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0;
  };
  return {mean_quality(paper), mean_quality(qualities(cloud, photographs, order.background)),
          share(misordered, rendered), share(misordered_blends, blends),
          penalties / static_cast<double>(photographs.size())};
}

}  // namespace sgs
