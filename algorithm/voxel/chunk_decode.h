// From the quantised bounds of a node's child (chunk_node.h) to numbers.
#pragma once

#include <cmath>

#include "algorithm/splat/scalar.h"

namespace sgs {

constexpr int kExtentSteps = 16;  // of an octave
constexpr int kMostExtent = 255;

// Of row q mod 16: 2^(-(15 - q mod 16) / 16), rounded up, so that no extent comes back smaller.
float extent_fraction(int q);

// x 2^exponent: an addition to its exponent.
inline float scaled_by_exponent(float x, int exponent) { return std::ldexp(x, exponent); }

// origin + q step.
template <class T>
T box_bound(T origin, T step, IndexOf<T> q) {
  return T(origin + number_of<T>(q) * step);
}

// 2^(exponent - (255 - q) / 16), where exponent is least + 15.
template <class T>
T extent_value(IndexOf<T> q, IndexOf<T> least) {
  return scaled_by_exponent(extent_fraction(q), least + q / kExtentSteps);
}
inline int least_extent_exponent(int exponent) { return exponent - kMostExtent / kExtentSteps; }

}  // namespace sgs
