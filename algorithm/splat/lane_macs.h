// How many multiply-accumulates a computation is on the lanes of a unit, and how many operations of
// the comparators beside them.
// A lane is one multiplier followed by one adder, fully pipelined: it starts one multiply-add a
// cycle.
#pragma once

#include <cstdint>

#include "algorithm/splat/operation_counts.h"

namespace sgs {

// Multiply-accumulates by which a lane makes what it has no hardware for. Each starts from a table
// of 8 bits, which two steps of Newton's iteration make 24 and more, and ends with the exact
// remainder, so that the result is the correctly rounded one that the source computes with
// (Markstein, "IA-64 and Elementary Functions", 2000; Goldschmidt's form for the root).
constexpr std::uint32_t kReciprocalMacs = 4;  // e = 1 - d r, r += r e; twice
constexpr std::uint32_t kQuotientMacs = 3;    // q = n r, rest = n - d q, q += rest r
constexpr std::uint32_t kSquareRootMacs = 9;  // g = x y; 2 (r = 1/2 - g h, g += g r, h += h r);
                                              // rest = x - g g, g += rest h
// The routine of the C library (16 intervals): exponent to float, z / c - 1 by table, log c + k
// ln2, r^2, and a cubic in r of 4.
constexpr std::uint32_t kLogarithmMacs = 8;
// exp_of in scalar.h: x / ln2 1, x - n ln2 2, polynomial 7.
constexpr std::uint32_t kExponentialMacs = 10;

// Lane cycles of a computation. An add is free where it takes a product that nothing else takes:
// the lane that makes the product adds as well. Every other multiply or add takes a lane's cycle of
// its own: max(multiplies, adds) would pair them regardless of what feeds what.
constexpr std::uint32_t folded_macs(const OperationCounts& c) {
  return c.multiplies + c.adds - c.fused + c.divisors * kReciprocalMacs +
         c.divisions * kQuotientMacs + c.square_roots * kSquareRootMacs +
         c.logarithms * kLogarithmMacs + c.exponentials * kExponentialMacs;
}

// What comparators do beside the lanes: each compares or adds two integers of 32 bits a cycle, or
// shifts one (five rows of selections: as many gates as a fast adder). A number's bits compare as
// its magnitude does.
constexpr std::uint32_t kRoundingComparisons = 3;  // shifted to its last place, rounded, back
constexpr std::uint32_t kSplitComparisons = 4;  // shifted, rounded; leading zeros of the rest, back
constexpr std::uint32_t kScalingComparisons = 1;     // an addition to the exponent
constexpr std::uint32_t kLogarithmComparisons = 1;   // the exponent apart
constexpr std::uint32_t kConversionComparisons = 2;  // leading zeros, shifted by them
// Two for the ends of its range; its whole number of ln2; the power of two.
constexpr std::uint32_t kExponentialComparisons = 2 + kRoundingComparisons + kScalingComparisons;

// Look-ups that such a computation starts from: of 8 bits for a reciprocal and a root, of an
// interval for a logarithm.
constexpr std::uint32_t seeds(const OperationCounts& c) {
  return c.divisors + c.square_roots + c.logarithms;
}

constexpr std::uint32_t comparisons(const OperationCounts& c) {
  return c.comparisons + c.roundings * kRoundingComparisons + c.splits * kSplitComparisons +
         c.scalings * kScalingComparisons + c.logarithms * kLogarithmComparisons +
         c.exponentials * kExponentialComparisons + c.conversions * kConversionComparisons +
         c.index_adds;
}

}  // namespace sgs
