// The order of blending: front to back, equal depths by index.
#pragma once

#include <cstdint>
#include <vector>

namespace sgs {

// The sorting key of one Gaussian of a frame.
struct DepthKey {
  std::uint32_t depth_bits;  // of v_z as float: positive floats order like their bit patterns
  std::uint32_t index;       // in the cloud
};

// Sorts by (depth, index). keys: by ascending index, fewer than 2^32.
void sort_front_to_back(std::vector<DepthKey>& keys);

}  // namespace sgs
