// How many operations of each class a computation takes. Signs (negation, absolute value)
// and selections are not counted, nor bits of a whole number that are moved or cleared.
#pragma once

#include <cstdint>

namespace sgs {

struct OperationCounts {
  std::uint32_t multiplies = 0;
  std::uint32_t adds = 0;       // and subtractions
  std::uint32_t fused = 0;      // of the adds: right behind a multiplication, in the same lane
  std::uint32_t divisions = 0;  // quotients; by a constant power of two they are multiplies
  std::uint32_t divisors = 0;   // different ones among them
  std::uint32_t square_roots = 0;
  std::uint32_t logarithms = 0;
  std::uint32_t exponentials = 0;
  std::uint32_t comparisons = 0;  // also minimum, maximum, test for infinity
  std::uint32_t roundings = 0;    // to a whole number
  std::uint32_t splits = 0;       // into whole steps and the rest
  std::uint32_t scalings = 0;     // by a power of two that is computed: added to the exponent
  std::uint32_t conversions = 0;  // of whole numbers to floats
  std::uint32_t index_adds = 0;   // of whole numbers
  std::uint32_t look_ups = 0;     // of a row of a table of coefficients
};

constexpr OperationCounts operator+(OperationCounts a, const OperationCounts& b) {
  a.multiplies += b.multiplies;
  a.adds += b.adds;
  a.fused += b.fused;
  a.divisions += b.divisions;
  a.divisors += b.divisors;
  a.square_roots += b.square_roots;
  a.logarithms += b.logarithms;
  a.exponentials += b.exponentials;
  a.comparisons += b.comparisons;
  a.roundings += b.roundings;
  a.splits += b.splits;
  a.scalings += b.scalings;
  a.conversions += b.conversions;
  a.index_adds += b.index_adds;
  a.look_ups += b.look_ups;
  return a;
}

}  // namespace sgs
