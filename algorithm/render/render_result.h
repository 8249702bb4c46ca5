// The results of renderers: the picture, and the counts of operations that a frame takes.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// The picture and, for each pixel, the light that is left and the number of splats blended.
struct RenderResult {
  RenderResult() = default;
  RenderResult(int width, int height)
      : image(width, height),
        transmittance(image.pixels.size()),
        contributors(image.pixels.size()) {}

  Image image;                              // colour composed over the background
  std::vector<float> transmittance;         // [height, width]
  std::vector<std::uint32_t> contributors;  // [height, width] splats blended
};

// The counts of a streaming frame. A visit streams one block: a voxel in paper order, a chunk in
// exact order.
struct StreamingStats {
  std::uint64_t groups = 0;
  std::uint64_t visits = 0;            // (group, block) pairs streamed
  std::uint64_t visits_saturated = 0;  // left out because the group was finished (paper order)
  std::uint64_t blocks_reached = 0;    // by at least one group, finished or not
  std::uint64_t first_halves = 0;      // Gaussians seen by the coarse filter
  std::uint64_t coarse_passed = 0;     // Gaussians that passed the coarse filter
  std::uint64_t second_halves = 0;     // fetched
  std::uint64_t fine_tests = 0;      // tests of these, one for each part of a group that wants them
  std::uint64_t splats = 0;          // Gaussians that passed both filters, likewise
  std::uint64_t subtile_blends = 0;  // (splat, 4x4 sub-tile) pairs
  std::uint64_t contributors = 0;    // (splat, pixel) blends
  std::uint64_t contributing = 0;    // Gaussians blended into at least one pixel of the frame
  std::uint64_t misordered = 0;      // blends behind a splat that is farther, at the same pixel
  std::uint64_t missed = 0;          // (group, splat) pairs that touch, in a block never visited
  // Paper order.
  std::uint64_t ray_steps = 0;
  std::uint64_t edges_offered = 0;
  std::uint64_t table_bytes_max = 0;   // ordering table of the worst group
  std::uint64_t visit_splats_max = 0;  // longest list that one visit sorts
  // Exact order.
  std::uint64_t nodes_read = 0;        // nodes of the chunk tree
  std::uint64_t pending_keys_max = 0;  // merged and not yet final, of the worst group
  std::uint64_t forced_early = 0;      // keys released before they were final (blend_early)

  // Adds counts, keeps the larger of the maxima.
  StreamingStats& operator+=(const StreamingStats& other);
};

struct StreamingResult {
  RenderResult frame;
  StreamingStats stats;
  std::vector<StreamingStats> of_groups;  // [group, row by row]; what is counted by frame is 0
  // Paper order: [group, row by row] the voxels that its rays cross, in visiting order.
  std::vector<std::vector<std::uint32_t>> group_voxels;
};

}  // namespace sgs
