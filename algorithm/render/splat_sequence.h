// All splats of a frame, front to back, in batches: the projection pass of a renderer that sees the
// whole scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/view.h"

namespace sgs {

// The sorting key of one Gaussian of a frame.
struct DepthKey {
  std::uint32_t depth_bits;  // v_z as float: positive floats order like their bit patterns
  std::uint32_t index;       // in the cloud
};

// Sorts by (depth, index). keys: by ascending index, fewer than 2^32.
void sort_front_to_back(std::vector<DepthKey>& keys);

// Only the keys of the whole frame are held (16 B a Gaussian near the frustum); splats are made as
// they are asked for. The same bits whatever the number of threads.
class SplatSequence {
 public:
  // Finds and sorts the Gaussians that may be visible. `cloud` must outlive the sequence. Throws
  // InputError when the cloud has 2^32 Gaussians or more.
  SplatSequence(const View<float>& view, const ActivatedCloud& cloud);

  // The keys of all Gaussians near the frustum, by (depth, index).
  const std::vector<DepthKey>& keys() const { return keys_; }

  bool at_end() const { return next_ == keys_.size(); }

  // Makes `batch` the splats, coloured, of the next `most` keys or of as many as there are. The
  // keys of Gaussians that turn out to be invisible give none: a batch may be empty before the end.
  void next(std::size_t most, std::vector<Splat>& batch);

 private:
  const View<float> view_;
  const ActivatedCloud& cloud_;
  std::vector<DepthKey> keys_;
  std::size_t next_ = 0;
};

}  // namespace sgs
