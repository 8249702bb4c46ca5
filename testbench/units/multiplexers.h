// The multiplexers that a word passes on its way from one of several memories.
#pragma once

#include <cstdint>

namespace sgs::tb {

// Multiplexers of two, for one of so many words.
inline std::uint64_t levels(std::uint64_t words) {
  std::uint64_t passed = 0;
  for (std::uint64_t reached = 1; reached < words; reached *= 2) ++passed;
  return passed;
}

}  // namespace sgs::tb
