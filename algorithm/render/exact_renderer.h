// Streaming renderer in exact order: the reference image, chunk by chunk. For each pixel group the
// chunks that can touch it are streamed by nearest depth; keys (depth, slot) of what passes the
// coarse filter wait until nothing nearer can come; only then is the rest of the Gaussian looked
// at.
#pragma once

#include <cstdint>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/order/on_overflow.h"
#include "algorithm/render/exact_work.h"
#include "algorithm/render/streaming_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

struct ExactOrderConfig {
  PixelSize group = square_of(64);     // of pixels rendered together, multiples of 4
  bool coarse_filter = true;           // off: keys of whole chunks wait
  std::uint32_t merge_entries = 4096;  // keys that wait at most, between two visits
  OnOverflow on_overflow = OnOverflow::kSpill;
  WalkRoom walk_room{256, 384};                        // of the front-to-back walk
  BlendPrecision precision = BlendPrecision::kSingle;  // of blending and of the pixels
  // What is counted beside the picture, and changes no pixel: sub-tiles of which splats; visits
  // behind a finished group, as many as can be under way in a machine that does not know it yet.
  SubtileTest subtile_test = SubtileTest::kEllipse;
  std::uint32_t visits_behind = 128;
  glm::vec3 background{0.0F};
};

// tree: of this cloud, which is in storage order. With kSpill the picture equals render_reference
// bit for bit. Deterministic whatever the number of threads.
StreamingResult render_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const ChunkTree& tree, const ExactOrderConfig& config);

// The same, counted; `walk_room` is not looked at, the walk has room for everything.
struct CountedExactFrame {
  StreamingResult result;
  ExactWork work;
};
CountedExactFrame count_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                    const ChunkTree& tree, const ExactOrderConfig& config);

}  // namespace sgs
