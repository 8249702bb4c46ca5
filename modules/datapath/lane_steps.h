// Cycles and parts of a datapath that a computation takes: by its counts, and step by step.
//
// A lane is one multiplier followed by one adder, fully pipelined (rtl/README.md): it starts one
// multiply-add a cycle. It adds to the rounded product, as the source does, or to the whole
// product, as quotients and roots need. The rounded product leaves it ahead of the sum. Operations
// without hardware of their own are made of such steps. A comparator's operation and a look-up take
// a cycle each. An answer of a comparison is no value: where it selects, it is the write enable of
// the value computed beside it, and is there before that is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/splat/data_flow.h"

namespace sgs {

// Multiply-accumulates of operations that a lane has no hardware for. Each starts from a table of 8
// bits, which two steps of Newton's iteration make 24 and more. It ends with the exact remainder,
// of a product that is not rounded. So the result is the correctly rounded one that the source
// computes with (Markstein, "IA-64 and Elementary Functions", 2000; Goldschmidt's form for the
// root).
constexpr std::uint32_t kReciprocalMacs = 4;  // e = 1 - d r, r += r e; twice
constexpr std::uint32_t kQuotientMacs = 3;    // q = n r, rest = n - d q, q += rest r
constexpr std::uint32_t kSquareRootMacs = 9;  // g = x y; 2 (r = 1/2 - g h, g += g r, h += h r);
                                              // rest = x - g g, g += rest h
// As the routine of the C library (16 intervals), which has double precision: exponent to float,
// z / c - 1 by table, log c + k ln2, r^2, and a cubic in r of 4.
constexpr std::uint32_t kLogarithmMacs = 8;
// exp_of in scalar.h, products rounded: x / ln2 1, x - n ln2 2, polynomial 7.
constexpr std::uint32_t kExponentialMacs = 10;

// Lane cycles of a computation. An add is free where the lane that makes a product adds to it as
// well: one add a product, whatever else takes that. Every other multiply or add takes a lane's
// cycle of its own: max(multiplies, adds) would pair them regardless of what feeds what.
constexpr std::uint32_t folded_macs(const OperationCounts& c) {
  return c.multiplies + c.adds - c.fused + c.divisors * kReciprocalMacs +
         c.divisions * kQuotientMacs + c.square_roots * kSquareRootMacs +
         c.logarithms * kLogarithmMacs + c.exponentials * kExponentialMacs;
}

// Operations of comparators beside the lanes: each compares or adds two integers of 32 bits a
// cycle, or shifts one (five rows of selections: as many gates as a fast adder). A number's bits
// compare as its magnitude does.
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

// Cycles from the operands to the result. Generated multiply-adders of single precision, which
// round once, have 3 to 5 stages at about 1 GHz (Galal and Horowitz, "Energy-Efficient
// Floating-Point Unit Design", IEEE Transactions on Computers, 2011). In half precision the
// multiplier's tree and the shifts are half as deep.
struct OperationLatencies {
  std::uint32_t lane = 3, comparator = 1, look_up = 1;

  // To a lane's product, which leaves it a cycle before the sum.
  constexpr std::uint32_t product() const { return lane > 1 ? lane - 1 : 1; }
};

// kLane: a lane's sum. kProduct: a lane's product, in a cycle of the lane; with a third source the
// lane adds that, for a step kSum that takes this product and needs no cycle of a lane.
enum class StepBy : std::uint8_t { kOutside, kLane, kComparator, kTable, kProduct, kSum };

// Cycles from the sources to the value.
constexpr std::uint32_t cycles_of(StepBy by, const OperationLatencies& latencies) {
  switch (by) {
    case StepBy::kOutside:
      return 0;
    case StepBy::kLane:
      return latencies.lane;
    case StepBy::kComparator:
      return latencies.comparator;
    case StepBy::kTable:
      return latencies.look_up;
    case StepBy::kProduct:
      return latencies.product();
    case StepBy::kSum:
      return latencies.lane - latencies.product();
  }
  return 0;
}

// Operations of parts beside the lanes. Some take several steps.
enum class BesideLane : std::uint8_t {
  kNone,
  kComparison,
  kRounding,
  kSplit,
  kScaling,
  kAddition,
  kConversion,
  kSeed,
  kLogarithm,
  kLookUp
};

// What a step takes a cycle of: a lane for a product, nothing for its sum.
constexpr StepBy part_kind(StepBy by) {
  return by == StepBy::kProduct ? StepBy::kLane : by == StepBy::kSum ? StepBy::kOutside : by;
}

struct LaneStep {
  // Source of one of its inputs: a constant's bits, or the value of a step before it.
  struct Source {
    std::uint32_t port;  // 0, 1: the factors of a lane, which can change places; 2: what it adds
    DataFlow::Operand value;
  };

  StepBy by = StepBy::kOutside;
  std::vector<Source> sources;
  BesideLane begins = BesideLane::kNone;  // the operation whose first step it is
  bool answers = false;                   // a comparison's answer, which is no value
  bool kept = false;                      // its value is wanted at the end
  // For a value from outside: 0 if it is there at the beginning, else the number of its list.
  // Values of a list come together, when the first of them is taken. Its sources are the answers
  // that say whether the list is read at all.
  std::uint32_t comes_with = 0;
};

constexpr std::uint32_t kAskedReadCycles = 1;  // of a value that comes if answers let it

// Cycles from the sources to the value; a value from outside is read once its answers are there.
inline std::uint32_t latency_of(const LaneStep& step, const OperationLatencies& latencies) {
  if (step.by == StepBy::kOutside) return step.sources.empty() ? 0 : kAskedReadCycles;
  return cycles_of(step.by, latencies);
}

// Different constants that the steps take: numbers of the frame, of the group, and of the code.
std::uint32_t constants_of(const std::vector<LaneStep>& steps);

// Steps that wait for each other, the longest in cycles. lane: sums that leave lanes. reads: of
// values that come if answers let them.
struct LongestPath {
  std::uint32_t lane = 0, comparator = 0, look_ups = 0, products = 0, reads = 0;

  constexpr std::uint32_t cycles(const OperationLatencies& each) const {
    return lane * each.lane + products * each.product() + comparator * each.comparator +
           look_ups * each.look_up + reads * kAskedReadCycles;
  }
  friend constexpr bool operator==(const LongestPath& a, const LongestPath& b) {
    return a.lane == b.lane && a.comparator == b.comparator && a.look_ups == b.look_ups &&
           a.products == b.products && a.reads == b.reads;
  }
};

// Longest path from the beginning, with all values from outside there.
LongestPath longest_path(const std::vector<LaneStep>& steps, const OperationLatencies& latencies);
// Longest path from values that come when they are needed, with all others there.
LongestPath longest_loop(const std::vector<LaneStep>& steps, const OperationLatencies& latencies);

// Nodes [first, last) of a data flow: the computation of one datapath. Values of earlier nodes come
// from outside.
struct FlowPart {
  std::shared_ptr<const DataFlow> flow;
  std::size_t first = 0, last = 0;
  // Inputs that are read when they are needed, those of one list at once; all else from outside is
  // there at the beginning. A comparison in a list says whether it is read.
  std::vector<std::vector<std::uint32_t>> together;

  OperationCounts counts() const { return flow->counts(first, last); }
  // Each step behind those that it takes.
  std::vector<LaneStep> steps(const OperationLatencies& latencies) const;
  LongestPath longest_path(const OperationLatencies& latencies) const {
    return sgs::longest_path(steps(latencies), latencies);
  }
};

inline FlowPart whole(const std::shared_ptr<const DataFlow>& flow) {
  return {flow, 0, flow->size(), {}};
}

}  // namespace sgs
