// Registers of a counter.
#pragma once

#include <cstdint>

namespace sgs {

// Of one that takes the values 0 to most.
constexpr std::uint32_t counter_bits(std::uint64_t most) {
  std::uint32_t bits = 0;
  for (; most > 0; most /= 2) ++bits;
  return bits;
}

}  // namespace sgs
