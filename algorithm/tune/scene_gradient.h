// From the derivatives of a loss with respect to pixels to those with respect to Gaussians: the
// backward pass of Kerbl et al. 2023, for any order of rendering.
#pragma once

#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/render/render_result.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// dL/d of a picture.
struct PixelGradient {
  Image colour;                      // rgb, background included
  std::vector<float> transmittance;  // [height, width] of what is left of the light beside that it
                                     // shows the background; empty: 0
};

// A picture to differentiate: draw(sequences, background, precision) == picture, and
// activate(parameters) == cloud.
struct DrawnScene {
  const View<float>& view;
  const GaussianCloud& parameters;
  const ActivatedCloud& cloud;
  const GroupSequences& sequences;
  const RenderResult& picture;
  glm::vec3 background{0.0F};
  BlendPrecision precision = BlendPrecision::kSingle;  // rounding to half passes gradients on
};

// dL/d of every Gaussian that is seen. The same bits whatever the number of threads: each group
// sums by itself, groups are added in their order. Working memory: 40 B an entry of the sequences,
// 37 B a splat; 140 B for each splat and sub-tile of the one group that each thread is at. `out`
// keeps its memory from call to call.
void scene_gradient(const DrawnScene& scene, const PixelGradient& by_pixel, GradientRule rule,
                    CloudGradient& out);

}  // namespace sgs
