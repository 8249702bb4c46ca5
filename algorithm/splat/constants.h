// The numeric constants of the original rasteriser, each with its reason.
#pragma once

namespace sgs {

constexpr double kNearPlane = 0.2;          // nearer centres are dropped
constexpr double kFrustumGuard = 1.3;       // clamp of v/z in the Jacobian: beyond, J is no use
constexpr double kLowPass = 0.3;            // px^2 on the diagonal: every splat covers a pixel
constexpr double kRadiusSigmas = 3.0;       // half-size of the square that picks the tiles
constexpr double kMinDiscriminant = 0.1;    // px^4: keeps the radius of a circular splat real
constexpr double kAlphaMax = 0.99;          // a splat never hides everything behind it
constexpr double kAlphaMin = 1.0 / 255.0;   // below, an 8-bit picture cannot show it
constexpr double kTransmittanceMin = 1e-4;  // below, a pixel is finished
constexpr int kTilePx = 16;                 // footprints are cut to whole tiles
constexpr int kSubtilePx = 4;               // side of the block that one rendering cluster blends
constexpr int kSubtilePixels = kSubtilePx * kSubtilePx;
constexpr int kSubtilesPerTile = kTilePx / kSubtilePx;
constexpr int kMaxFramePx = 131'072;  // a side; what the slack in footprint.h is counted for

constexpr double kLog2E = 1.4426950408889634;

// sqrt(2 ln 255): beyond so many sigmas even an opaque splat is below kAlphaMin.
constexpr double kVisibleSigmas = 3.3290429691304455;

}  // namespace sgs
