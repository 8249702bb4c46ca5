// A scene's picture beside its photograph by the loss of Kerbl et al. 2023, and the derivative by
// every parameter.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/photometric_loss.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// The loss by which a picture and its photograph are compared, and its gradient rule.
struct ComparisonRule {
  double ssim_share = kSsimShare;
  GradientRule gradients = GradientRule::kDerivative;
};

// The loss. counts: as Photographs has them; pixels that do not count are black in both pictures,
// and the loss is a mean over all. sequences: of parameters that activate(parameters) == cloud.
// gradient: dloss/dparameters.
double compare_with(const Image& target, const std::vector<std::uint8_t>& counts,
                    const View<float>& view, const GaussianCloud& parameters,
                    const ActivatedCloud& cloud, const GroupSequences& sequences,
                    const glm::vec3& background, BlendPrecision precision,
                    const ComparisonRule& rule, CloudGradient& gradient);

// Black where a pixel does not count. counts: one for each pixel, or none: then all count.
void blacken(Image& image, const std::vector<std::uint8_t>& counts);

// Throws NotFinite where a derivative or the loss is no finite number. step: from 0.
void check_finite(int step, double loss, const CloudGradient& gradient);

// beyond: as Adam::step returns it. Throws NotFinite where there is one.
void check_limits(int step, const std::optional<std::uint32_t>& beyond);

}  // namespace sgs
