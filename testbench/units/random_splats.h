// Splats as the fine filter could hand them on, and groups of a frame for them to lie in.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "algorithm/splat/splat.h"
#include "modules/streaminggs/streaming_job.h"

namespace sgs::tb {

// A frame of width x height px with its groups and, behind the layout's regions, a spill region and
// a frame buffer.
StreamingJob frame_job(int width_px, int height_px, const PixelSize& group, FrameFormat format,
                       std::uint64_t spill_bytes, const SceneLayout& layout = {});

// A splat whose footprint overlaps the group. Depths are few, so that many are equal. opacity: at
// most this.
Splat random_splat(std::mt19937_64& random, const PixelRect& group, const FrameJob& job,
                   std::uint32_t index, float opacity);

// Sub-tiles of a group.
SubtileRect subtiles_of(const PixelRect& pixels);

// Empty where both are the same to the bit; else which field differs. Footprints are compared
// where they overlap the group.
std::string difference(const Splat& got, const Splat& expected, const SubtileRect& group);

}  // namespace sgs::tb
