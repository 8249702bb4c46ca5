// How many multiply-accumulates a computation is on the lanes of a filter unit.
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
// exp_of in scalar.h: clamp 2, n = round(x / ln2) 2, x - n ln2 2, polynomial 7, scaling by 2^n 1.
constexpr std::uint32_t kExponentialMacs = 14;
// The adder of a lane: the sign of a difference; adding 1.5 x 2^23 leaves a whole number.
constexpr std::uint32_t kComparisonMacs = 1;
constexpr std::uint32_t kRoundingMacs = 1;

// Lane cycles of a computation. An add is free where it takes a product that nothing else takes:
// the lane that makes the product adds as well. Every other multiply or add takes a lane's cycle of
// its own: max(multiplies, adds) would pair them regardless of what feeds what.
constexpr std::uint32_t folded_macs(const OperationCounts& c) {
  return c.multiplies + c.adds - c.fused + c.divisors * kReciprocalMacs +
         c.divisions * kQuotientMacs + c.square_roots * kSquareRootMacs +
         c.logarithms * kLogarithmMacs + c.exponentials * kExponentialMacs +
         c.comparisons * kComparisonMacs + c.roundings * kRoundingMacs;
}

}  // namespace sgs
