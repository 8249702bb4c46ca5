// How the codebooks of a scene are made.
#pragma once

#include <cstdint>

#include "algorithm/memory/codebook.h"

namespace sgs {

struct VqConfig {
  std::uint32_t scale_entries = 4096;
  std::uint32_t rotation_entries = 4096;
  std::uint32_t dc_entries = 4096;
  std::uint32_t sh_entries = 512;
  std::uint32_t iterations = 20;
  std::uint64_t seed = 1;

  std::uint32_t entries(Codebook codebook) const {
    const std::uint32_t all[kCodebookCount] = {scale_entries, rotation_entries, dc_entries,
                                               sh_entries};
    return all[static_cast<std::size_t>(codebook)];
  }
};

// Its keys, for a visitor as modules/config has.
template <class Visitor>
void visit(Visitor& v, VqConfig& c) {
  constexpr std::uint32_t kMost = kMaxCodebookEntries;
  v("scale_entries", c.scale_entries, {1, kMost}, "most entries of the scale codebook");
  v("rotation_entries", c.rotation_entries, {1, kMost}, "of the rotation codebook");
  v("dc_entries", c.dc_entries, {1, kMost}, "of the codebook of base colours");
  v("sh_entries", c.sh_entries, {1, kMost}, "of the codebook of the higher bands");
  v("iterations", c.iterations, {0, 1000}, "of k-means, at most");
  v("seed", c.seed, {0, INT64_MAX}, "of k-means");
}

}  // namespace sgs
