// The reference renderer: the image that every other renderer of the project is judged against
// (3D Gaussian Splatting, Kerbl et al. 2023: tiles of 16x16 pixels, splats front to back).
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs {

// Renders the whole cloud. Each pixel blends the splats whose footprint holds its sub-tile, by
// (depth, index). The same bits whatever the number of threads. Working memory beside the result:
// 60 B a visible Gaussian and a bounded part for the bins, however many tiles the splats cover.
RenderResult render_reference(const View<float>& view, const ActivatedCloud& cloud,
                              const glm::vec3& background = glm::vec3(0.0F));

// Where the order of a cloud's Gaussians shows: among those of equal depth.

// One flag for each tile of kTilePx, row by row: whether two Gaussians of a depth fall on it that
// `ranks` (of each Gaussian, all different) order otherwise than their indices do, or may. On all
// other tiles the reference picture of the cloud in the order of `ranks` is that of the cloud as it
// is, bit for bit.
std::vector<char> tiles_of_ties(const View<float>& view, const ActivatedCloud& cloud,
                                const std::vector<std::uint32_t>& ranks);

// The reference picture of the cloud in the order of `ranks`. tiles: of these ties; picture: the
// reference picture of the cloud as it is, which gives the other tiles.
Image picture_by_ranks(const View<float>& view, const ActivatedCloud& cloud,
                       const std::vector<std::uint32_t>& ranks, const glm::vec3& background,
                       const std::vector<char>& tiles, const Image& picture);

}  // namespace sgs
