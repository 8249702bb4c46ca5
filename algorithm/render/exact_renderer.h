// Streaming renderer in exact order: the reference image, chunk by chunk. For each pixel group the
// chunks that can touch it are streamed by nearest depth; keys (depth, slot) of what passes the
// coarse filter wait until nothing nearer can come; only then is the rest of the Gaussian looked
// at. The order is this project's; the filters are those of StreamingGS (DAC 2025).
#pragma once

#include <cstdint>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

// The way out when more keys wait than the merge buffer holds.
enum class OnOverflow {
  kSpill,       // sorted runs go to DRAM and come back: the image stays exact
  kBlendEarly,  // the nearest keys are released before they are final: the image may suffer
};

struct ExactOrderConfig {
  PixelSize group = square_of(64);     // pixels rendered together, multiples of 4
  bool coarse_filter = true;           // off: keys of whole chunks wait
  std::uint32_t merge_entries = 4096;  // keys that wait at most, between two visits
  OnOverflow on_overflow = OnOverflow::kSpill;
  WalkRoom walk_room{256, 384};                        // room for the front-to-back walk
  BlendPrecision precision = BlendPrecision::kSingle;  // precision of blending and of the pixels
  SubtileTest subtile_test = SubtileTest::kEllipse;
  glm::vec3 background{0.0F};
};

// tree: of this cloud, which is in storage order. With kSpill the picture equals render_reference
// bit for bit. Deterministic whatever the number of threads.
StreamingResult render_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const ChunkTree& tree, const ExactOrderConfig& config);

}  // namespace sgs
