// What a test of a chunk's bound executes, counted by running it with the counting scalar. Values
// of the camera and of the group are constants, as in algorithm/splat/filter_work.h.
#pragma once

#include "algorithm/scene/camera.h"
#include "algorithm/splat/lane_steps.h"
#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"
#include "algorithm/splat/rects.h"
#include "algorithm/voxel/chunk_node.h"

namespace sgs {

// A chunk, and the view and group it is tested against.
struct ChunkCase {
  Camera camera;
  ChunkBound bound;
  PixelRect group;
};

// A chunk that touches its group: all four sides are looked at. A unit that starts a test at fixed
// intervals has to be built for this.
ChunkCase longest_chunk_case();

// Of one test, up to where it fails or to its end, with what the walk does to its result. The child
// is decoded from its node: box bounds origin + q 2^e, extents by table.
OperationCounts chunk_work(const ChunkCase& tested);
LongestPath chunk_path(const ChunkCase& tested, const OperationLatencies& latencies);
std::vector<LaneStep> chunk_steps(const ChunkCase& tested, const OperationLatencies& latencies);

}  // namespace sgs
