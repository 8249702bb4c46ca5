// How the codebooks of a scene are made.
#pragma once

#include <cstdint>

#include "algorithm/memory/codebook.h"

namespace sgs {

struct VqConfig {
  std::uint32_t scale_entries = 4096;  // most entries of each codebook
  std::uint32_t rotation_entries = 4096;
  std::uint32_t dc_entries = 4096;
  std::uint32_t sh_entries = 512;
  std::uint32_t iterations = 20;  // of k-means, at most
  std::uint64_t seed = 1;

  std::uint32_t entries(Codebook codebook) const {
    const std::uint32_t all[kCodebookCount] = {scale_entries, rotation_entries, dc_entries,
                                               sh_entries};
    return all[static_cast<std::size_t>(codebook)];
  }
};

}  // namespace sgs
