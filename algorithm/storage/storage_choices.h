// What a storage configuration may leave open (0), chosen by rules that say why.
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/splat/gaussian.h"

namespace sgs {

template <class T>
struct Choice {
  T value;
  std::string why;  // a sentence with the numbers
};

// The same of a key below `storage`.
struct StorageChoice {
  const char* key;
  double value;
  std::string why;
};

// World units, by the inner extent of the scene (voxel_grid.h).
Choice<double> choose_voxel_size(const ActivatedCloud& cloud);

// run_bytes: what lies together in one row of one memory channel. A chunk's first halves fill it:
// smaller chunks cost more tree records than they save, larger ones stream Gaussians that the group
// does not need.
Choice<std::uint32_t> choose_chunk_gaussians(std::uint32_t run_bytes);

}  // namespace sgs
