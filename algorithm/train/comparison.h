// A scene's picture beside its photograph by the loss of Kerbl et al. 2023, and the derivative by
// every parameter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"
#include "algorithm/tune/additional_losses.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/photometric_loss.h"
#include "algorithm/tune/splat_gradient.h"
#include "algorithm/voxel/voxel_grid.h"

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

// The quality of a scene's pictures beside photographs.
struct Quality {
  double psnr_db, ssim;
};

// Of the pixels that count (Photographs): the mean square error over them alone; SSIM where those
// that do not are black in both pictures, and are taken to be alike.
Quality quality_of(const Image& picture, const Image& target,
                   const std::vector<std::uint8_t>& counts);

// Is shown what the scene looks like from where photograph `at` was taken.
using PictureSeen = std::function<void(std::size_t at, const Image& picture)>;

// The quality at each photograph, before `background`, in the reference order. The scene's picture
// is rounded to 8 bits neither here nor in PSNR.
std::vector<Quality> qualities(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background, const PictureSeen& seen = {});

// Means over all of them, PSNR in dB.
Quality mean_quality(const std::vector<Quality>& each);

// The quality of paper order's pictures of a scene, and the share of them that is out of order:
// means over the photographs; shares of all views together.
struct PaperQuality {
  Quality paper;                // pictures in paper order, as the golden renderer draws them
  Quality reference;            // reference pictures of the same scene
  double misordered_gaussians;  // share of (group, Gaussian) pairs that are rendered
  double misordered_pixels;     // share of blends behind a splat that is farther, at the same pixel
  double penalty;               // L_CBP
};

// grid: of this cloud, which is in storage order. seen: is shown the pictures in paper order.
PaperQuality paper_quality(const ActivatedCloud& cloud, const VoxelGrid& grid,
                           const PaperOrderConfig& order, const BoundaryPenaltyConfig& penalty,
                           const Photographs& photographs, const PictureSeen& seen = {});

}  // namespace sgs
