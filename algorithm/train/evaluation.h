// The quality of a scene's pictures beside photographs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/photographs.h"
#include "algorithm/tune/boundary_penalty.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

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
