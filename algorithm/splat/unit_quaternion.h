// The component of a unit quaternion that follows from the other three.
#pragma once

#include <array>
#include <cstdint>

#include "algorithm/splat/scalar.h"

namespace sgs {

// Not negative. In this order of operations, each rounded to T.
template <class T>
T largest_component(const std::array<T, 3>& others) {
  T squared = T(1.0F);
  for (const T& other : others) squared = T(squared - T(other * other));
  return sqrt_of(max_of(T(0.0F), squared));
}

// x and so many units in its last place: an addition to its bits.
inline float moved_by_units(float x, int units) {
  return __builtin_bit_cast(float, __builtin_bit_cast(std::int32_t, x) + units);
}

}  // namespace sgs
