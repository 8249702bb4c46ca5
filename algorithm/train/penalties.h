// What tunings add to the photometric loss.
#pragma once

#include <functional>

#include "algorithm/tune/boundary_penalty.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/streaming_price.h"

namespace sgs {

// Adds its derivative to the gradient of the picture of these sequences; returns its part of the
// loss. cloud: activate(parameters).
using Penalty = std::function<double(const View<float>& view, const GroupSequences& sequences,
                                     const GaussianCloud& parameters, const ActivatedCloud& cloud,
                                     CloudGradient& gradient)>;

// beta L_CBP. precision: that the sequences are drawn in.
inline Penalty boundary_loss(double beta, BlendPrecision precision,
                             const BoundaryPenaltyConfig& config) {
  return [=](const View<float>&, const GroupSequences& sequences, const GaussianCloud&,
             const ActivatedCloud& cloud, CloudGradient& gradient) {
    const BoundaryPenalty penalty = boundary_penalty(sequences, cloud, precision, config);
    add_boundary_gradient(penalty, beta, sequences, cloud, gradient);
    return beta * penalty.value;
  };
}

// weight times the mean price of streaming.
inline Penalty streaming_loss(double weight, const PixelSize& group) {
  return
      [=](const View<float>& view, const GroupSequences& sequences, const GaussianCloud& parameters,
          const ActivatedCloud& cloud, CloudGradient& gradient) {
        return weight *
               add_streaming_gradient(view, sequences, parameters, cloud, group, weight, gradient);
      };
}

}  // namespace sgs
