// Operations that wait for each other, and the cycles that they take: the depth of a pipeline.
//
// A lane is a fused multiply-adder in a few stages; what it has no hardware for is made of such
// steps (lane_macs.h), of which here those in a row count. A comparator's operation and a look-up
// take a cycle each. An answer of a comparison is no value: where it selects, it is the write
// enable of what is computed beside it, and is there before that is.
#pragma once

#include <cstdint>

#include "algorithm/splat/operation.h"

namespace sgs {

// Cycles from the operands to the result. Generated fused multiply-adders of single precision at
// about 1 GHz have 3 to 5 stages (Galal and Horowitz, "Energy-Efficient Floating-Point Unit
// Design", IEEE Transactions on Computers, 2011); in half precision the multiplier's tree and the
// shifts are half as deep.
struct OperationLatencies {
  std::uint32_t lane = 3, comparator = 1, look_up = 1;
};

struct LongestPath {
  std::uint32_t lane = 0, comparator = 0, look_ups = 0;

  constexpr std::uint32_t operations() const { return lane + comparator + look_ups; }
  constexpr std::uint32_t cycles(const OperationLatencies& each) const {
    return lane * each.lane + comparator * each.comparator + look_ups * each.look_up;
  }
  friend constexpr LongestPath operator+(const LongestPath& a, const LongestPath& b) {
    return {a.lane + b.lane, a.comparator + b.comparator, a.look_ups + b.look_ups};
  }
  friend constexpr bool operator==(const LongestPath& a, const LongestPath& b) {
    return a.lane == b.lane && a.comparator == b.comparator && a.look_ups == b.look_ups;
  }
};

// From a divisor to its reciprocal: the seed, then e = 1 - d r and r += r e, twice.
constexpr LongestPath kReciprocalPath{4, 0, 1};

// From an operand to the result; of a quotient, from the reciprocal.
constexpr LongestPath path_of(Operation operation) {
  switch (operation) {
    case Operation::kInput:
    case Operation::kNegate:
    case Operation::kAbsolute:
    case Operation::kMoveBits:
    case Operation::kMaskBits:
      return {};
    case Operation::kMultiply:
    case Operation::kAdd:
    case Operation::kSubtract:
      return {1, 0, 0};
    case Operation::kDivide:
      return {3, 0, 0};  // q = n r, rest = n - d q, q += rest r
    case Operation::kSquareRoot:
      return {7, 0, 1};  // seed; g = x y; twice r = 1/2 - g h, then g and h at once; rest, g
    case Operation::kLogarithm:
      return {4, 1, 1};  // exponent apart; z / c - 1; r^2; two of the cubic's four, the rest beside
    case Operation::kExponential:
      return {10, 4, 0};  // x / ln2, rounded, x - n ln2 in 2, polynomial 7, power of two
    case Operation::kLookUp:
      return {0, 0, 1};
    case Operation::kSplit:
      return {0, 4, 0};
    case Operation::kCompare:
    case Operation::kMinimum:
    case Operation::kMaximum:
    case Operation::kIsFinite:
    case Operation::kScale:
    case Operation::kAddIndex:
      return {0, 1, 0};
    case Operation::kFromIndex:
      return {0, 2, 0};
    case Operation::kCeil:
    case Operation::kFloor:
    case Operation::kTruncate:
    case Operation::kRound:
      return {0, 3, 0};
  }
  return {};
}

}  // namespace sgs
