// The test of a chunk against a pixel group, put to brute force: it never says no where a Gaussian
// could be blended, and its nearest depth is never beyond a Gaussian's.
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/splat/rects.h"
#include "algorithm/voxel/chunk_tree.h"
#include "tests/algorithm/voxel/hard_scenes.h"

namespace sgs::test {

struct BoundTally {
  std::uint64_t chunks = 0, accepted = 0, in_vain = 0;  // (chunk, group) pairs
  std::uint64_t splats = 0;                             // (Gaussian, group) pairs that may blend
  std::string failure;                                  // empty: none
};

// Whether `outer` holds all that `inner` holds.
bool holds(const ChunkBound& outer, const ChunkBound& inner);

// All chunks and inner nodes of the scene's tree against all groups of its frame.
void check_chunk_bounds(const HardScene& scene, std::uint32_t chunk, const PixelSize& group_size,
                        BoundTally& tally);

// Random hard scenes; prints how tight the test is. most_apart: of the two eyes, world units; 0:
// one.
void fuzz_chunk_bounds(unsigned first_seed, unsigned scenes, double most_apart = 0);

// Random Gaussians moved sideways until they only just reach a group: the least favourable place
// for the test, which knows their exact bounds here. Returns how many there were.
int check_bounds_at_the_edge(unsigned seed, int gaussians);

}  // namespace sgs::test
