// The reference renderer: the image that every other renderer of the project is judged against
// (3D Gaussian Splatting, Kerbl et al. 2023: tiles of 16x16 pixels, splats front to back).
#pragma once

#include "algorithm/render/render_result.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs {

// Renders the whole cloud. Each pixel blends the splats whose footprint holds its sub-tile, by
// (depth, index). The same bits whatever the number of threads. Working memory beside the result:
// 60 B a visible Gaussian and a bounded part for the bins, however many tiles the splats cover.
RenderResult render_reference(const View<float>& view, const ActivatedCloud& cloud,
                              const glm::vec3& background = glm::vec3(0.0F));

}  // namespace sgs
