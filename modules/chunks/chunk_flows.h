// Operations of testing a chunk against a rectangle of pixels, recorded by running the test.
#pragma once

#include <cstdint>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/chunk_tree.h"
#include "modules/datapath/lane_steps.h"

namespace sgs {

// A chunk, and the view and group it is tested against.
struct ChunkCase {
  Camera camera;
  ChunkBound bound;
  PixelRect group;
};

// A chunk that touches its group: all four sides are looked at. A unit that starts a test at fixed
// intervals has to be built for this.
// eyes: 2 for the view of two.
ChunkCase longest_chunk_case(std::uint32_t eyes = 1);

// Operations of one test, up to where it fails or to its end, with the walk's use of its result.
// The child is decoded from its node: box bounds origin + q 2^e, extents by table. Values of the
// camera and of the group are constants.
FlowPart chunk_flow(const ChunkCase& tested);

// The same for a walk that asks only whether the chunk touches: no depth, no sub-tiles.
FlowPart chunk_culling_flow(const ChunkCase& tested);

}  // namespace sgs
