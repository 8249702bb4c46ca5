// What a computation can consist of, as the counting scalar records it.
#pragma once

#include <cstdint>

namespace sgs {

enum class Operation : std::uint8_t {
  kInput,
  kNegate,
  kAbsolute,
  kMultiply,
  kAdd,
  kSubtract,
  kDivide,
  kSquareRoot,
  kLogarithm,
  kExponential,
  kLookUp,  // a row of a table
  kSplit,   // into whole steps and a rest
  kScale,   // by a power of two that is computed
  kCompare,
  kMinimum,
  kMaximum,
  kIsFinite,
  kCeil,
  kFloor,
  kTruncate,
  kRound,
  kFromIndex,  // a whole number becomes a float
  kAddIndex,   // of two whole numbers
  kMoveBits,   // of a whole number, by places that are known: wires
  kMaskBits    // of a whole number: set or cleared
};

}  // namespace sgs
