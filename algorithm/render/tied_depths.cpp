// Neighbours in the order of blending.
#include "algorithm/render/tied_depths.h"

#include <algorithm>

#include "algorithm/render/splat_sequence.h"

namespace sgs {

bool reorders_ties(const View<float>& view, const ActivatedCloud& cloud,
                   const std::vector<std::uint32_t>& ranks) {
  const SplatSequence sequence(view, cloud);
  const std::vector<DepthKey>& keys = sequence.keys();
  const auto swapped = [&](const DepthKey& a, const DepthKey& b) {
    return a.depth_bits == b.depth_bits && ranks[a.index] > ranks[b.index];
  };
  return std::adjacent_find(keys.begin(), keys.end(), swapped) != keys.end();
}

}  // namespace sgs
