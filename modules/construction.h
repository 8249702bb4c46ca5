// The order in which a machine's units are made.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace sgs {

using Construction = std::vector<std::function<void()>>;

// Makes each part: as listed for order 0, else shuffled by it. The kernel runs processes in the
// order in which they were made, which must not show in any result.
inline void construct(Construction parts, std::uint64_t order) {
  if (order != 0) std::shuffle(parts.begin(), parts.end(), std::mt19937_64(order));
  for (const std::function<void()>& make : parts) make();
}

}  // namespace sgs
