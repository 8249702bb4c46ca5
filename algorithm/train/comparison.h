// A scene's picture beside its photograph, and which way every parameter brings it nearer.
#pragma once

#include "algorithm/image/image.h"
#include "algorithm/render/render_result.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"

namespace sgs {

struct Comparison {
  RenderResult picture;
  double loss, l1, ssim;
};

// sequences: of parameters that activate(parameters) == cloud. gradient: dloss/dparameters.
Comparison compare_with(const Image& target, const View<float>& view,
                        const GaussianCloud& parameters, const ActivatedCloud& cloud,
                        const GroupSequences& sequences, const glm::vec3& background,
                        BlendPrecision precision, double ssim_share, CloudGradient& gradient);

// Throws NotFinite where the loss or a derivative is no finite number.
void check_finite(int step, double loss, const CloudGradient& gradient);

}  // namespace sgs
