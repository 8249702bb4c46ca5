// splat_gradient.h for the 16 pixels of a sub-tile at a time, in float.
#pragma once

#include "algorithm/splat/blend.h"
#include "algorithm/splat/splat.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {

// The pixels of a sub-tile while their blending is differentiated.
struct SubtileAdjoint {
  float red[kSubtilePixels], green[kSubtilePixels], blue[kSubtilePixels];  // dL/dC
  float behind[kSubtilePixels];  // `behind` of splat_gradient.h, for the next splat
};

// FalloffMoments of one splat, each lane by itself; over any number of sub-tiles.
struct alignas(64) LaneMoments {
  float one[kSubtilePixels] = {}, x[kSubtilePixels] = {}, y[kSubtilePixels] = {};
  float xx[kSubtilePixels] = {}, xy[kSubtilePixels] = {}, yy[kSubtilePixels] = {};
  float red[kSubtilePixels] = {}, green[kSubtilePixels] = {}, blue[kSubtilePixels] = {};
};

// Adds what the splat did to the sub-tile (subtile_x, subtile_y) of the frame, and puts it behind
// the splats in front of it. shares: as the blend pass tells them.
void add_gradient(const LaneShares& shares, int subtile_x, int subtile_y, const Splat& splat,
                  SubtileAdjoint& adjoint, LaneMoments& moments);
// The same by GradientRule::kOriginal.
void add_original_gradient(const LaneShares& shares, int subtile_x, int subtile_y,
                           const Splat& splat, SubtileAdjoint& adjoint, LaneMoments& moments);

// Sums over the lanes, in one order on every machine.
FalloffMoments<float> total(const LaneMoments& moments);

}  // namespace sgs
