// The cross-boundary penalty of StreamingGS (DAC 2025), L_CBP = 1/N sum_i T_i S_i: Gaussians that
// are blended out of order, by their size. T_i = 1 where depth_i is below the largest depth of the
// Gaussians rendered before it, S_i is its largest scale. For each view and group of pixels, the
// running maximum beginning anew with each group; a Gaussian counts in each group in which it is
// rendered, which is: blended into some pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"

namespace sgs {

// The Gaussians before which one is out of order: the paper says no more than "rendered before it".
// kGroup: anywhere in the group. kPixel: at one of the pixels that it is blended into itself, which
// is where it costs something.
enum class MisorderedIn { kGroup, kPixel };

// N, which the paper leaves open too, counts the (group, Gaussian) pairs that are rendered, or the
// Gaussians of the scene.
enum class PenaltyMean { kRendered, kScene };

struct BoundaryPenaltyConfig {
  MisorderedIn in = MisorderedIn::kGroup;
  PenaltyMean mean = PenaltyMean::kRendered;
};

struct BoundaryPenalty {
  double value = 0;                   // L_CBP, world units
  double count = 0;                   // N
  std::uint64_t rendered = 0;         // (group, Gaussian) pairs
  std::uint64_t misordered = 0;       // misordered pairs among these
  std::vector<std::uint32_t> groups;  // [splats] in how many T_i = 1
};

// sequences: of this cloud. The same bits whatever the number of threads.
BoundaryPenalty boundary_penalty(const GroupSequences& sequences, const ActivatedCloud& cloud,
                                 BlendPrecision precision, const BoundaryPenaltyConfig& config);

// Adds beta dL_CBP/dlog_scale. T_i is a decision and has no derivative. gradient: of a picture of
// these sequences, so that all that is rendered has a row in it.
void add_boundary_gradient(const BoundaryPenalty& penalty, double beta,
                           const GroupSequences& sequences, const ActivatedCloud& cloud,
                           CloudGradient& gradient);

}  // namespace sgs
