// Groups of pixels, or tiles, by their numbers.
#pragma once

#include <cstdint>

namespace sgs {

// Both ends are among them.
struct GroupRange {
  std::uint32_t first = 0, last = UINT32_MAX;
  bool holds(std::uint32_t group) const { return first <= group && group <= last; }
  bool all() const { return first == 0 && last == UINT32_MAX; }
};

}  // namespace sgs
