// A datapath from what was counted by running its code, and its depth, registers and multiplexers
// from the schedule of its steps on its lanes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/memory/number_format.h"
#include "modules/datapath/folded_pipeline.h"
#include "tlm/datapath.h"

namespace sgs {

// Rows of the technology table, for numbers of one format. A lane for quotients and roots adds to
// the whole product, too.
struct PartsOfFormat {
  const char *lane, *quotient_lane;
  const char *comparator, *split, *scaling, *exp2_rows;
};
constexpr PartsOfFormat kSingleParts{"fp32_chaining_lane", "fp32_lane", "number_comparator",
                                     "exp2_split",         "adder",     "exp2_table"};
constexpr PartsOfFormat kHalfParts{"fp16_lane",       "fp16_lane",  "half_comparator",
                                   "exp2_split_half", "half_scale", "exp2_table_half"};

// Steps of a schedule that an operation of a part beside the lanes takes.
struct StepsOfPart {
  const char* kind;
  BesideLane does;
  std::uint32_t comparator, table;
};
constexpr StepsOfPart kStepsOfParts[] = {
    {"number_comparator", BesideLane::kComparison, 1, 0},
    {"half_comparator", BesideLane::kComparison, 1, 0},
    {"half_scale", BesideLane::kScaling, kScalingComparisons, 0},
    {"adder", BesideLane::kAddition, 1, 0},
    {"conversion", BesideLane::kConversion, kConversionComparisons, 0},
    {"rounding", BesideLane::kRounding, kRoundingComparisons, 0},
    {"exp2_split", BesideLane::kSplit, kSplitComparisons, 0},
    {"exp2_split_half", BesideLane::kSplit, kSplitComparisons, 0},
    {"seed_table", BesideLane::kSeed, 0, 1},
    {"logarithm_table", BesideLane::kLogarithm, kLogarithmComparisons, 1},
    {"reach_table", BesideLane::kLookUp, 0, 1},
    {"exp2_table", BesideLane::kLookUp, 0, 1},
    {"exp2_table_half", BesideLane::kLookUp, 0, 1}};

inline StepsOfPart steps_of(const std::string& kind) {
  for (const StepsOfPart& part : kStepsOfParts) {
    if (part.kind == kind) return part;
  }
  throw std::logic_error(kind + ": no part beside lanes");
}

// Charged with what was counted, one lane until it is said otherwise. Beside the lanes stand parts
// for what they do not: comparisons, whole numbers, and tables. An exponential compares with both
// ends of its range.
inline Datapath counted_datapath(const char* name, const char* component, const OperationCounts& c,
                                 NumberFormat format = NumberFormat::kSingle) {
  const PartsOfFormat& parts = format == NumberFormat::kHalf ? kHalfParts : kSingleParts;
  const bool has_quotients = c.divisions + c.square_roots > 0;
  Datapath path;
  path.name = name;
  path.component = component;
  path.lane = has_quotients ? parts.quotient_lane : parts.lane;
  path.used_macs = path.counted_macs = folded_macs(c);
  path.counts = {{"multiplies", c.multiplies},
                 {"adds", c.adds},
                 {"fused", c.fused},
                 {"divisions", c.divisions},
                 {"divisors", c.divisors},
                 {"square_roots", c.square_roots},
                 {"logarithms", c.logarithms},
                 {"exponentials", c.exponentials},
                 {"comparisons", c.comparisons},
                 {"roundings", c.roundings},
                 {"splits", c.splits},
                 {"scalings", c.scalings},
                 {"conversions", c.conversions},
                 {"index_adds", c.index_adds},
                 {"look_ups", c.look_ups}};
  const std::pair<const char*, std::uint32_t> beside[] = {
      {parts.comparator, c.comparisons + 2 * c.exponentials},
      {"rounding", c.roundings + c.exponentials},
      {parts.split, c.splits},
      {parts.scaling, c.scalings + c.exponentials},
      {"adder", c.index_adds},
      {"conversion", c.conversions},
      {"seed_table", c.divisors + c.square_roots},
      {"logarithm_table", c.logarithms},
      {c.splits > 0 ? parts.exp2_rows : "reach_table", c.look_ups}};
  for (const auto& [kind, operations] : beside) {
    if (operations > 0) path.part_of(kind).operations += operations;
  }
  return path;
}

constexpr std::uint32_t kSingleBits = 32, kHalfBits = 16;

// The lanes of one copy, what keeps pace with them, and an item every so many cycles. A schedule
// does not tell apart comparators, adders and the like, nor tables.
inline FoldedParts parts_of(const Datapath& path, std::uint32_t interval_cycles) {
  std::uint64_t comparators = 0, tables = 0;
  for (const BesideLanes& beside : path.beside) {
    const StepsOfPart steps = steps_of(beside.kind);
    comparators += std::uint64_t{beside.operations} * steps.comparator;
    tables += std::uint64_t{beside.operations} * steps.table;
  }
  const auto at_full_rate = [&](std::uint64_t steps) {
    return static_cast<std::uint32_t>((steps * path.lanes + path.used_macs - 1) / path.used_macs);
  };
  return {path.lanes, at_full_rate(comparators), at_full_rate(tables), interval_cycles};
}

inline BetweenLanes between_lanes(const LaneWiring& wiring, std::uint32_t value_bits) {
  return {value_bits * wiring.register_words, value_bits * wiring.select_words,
          value_bits * wiring.words_written, value_bits * wiring.words_selected};
}

// Whether a part does such operations. An adder scales numbers in single precision, too.
inline bool does(const BesideLanes& part, BesideLane operation) {
  if (operation == BesideLane::kScaling && part.kind == kSingleParts.scaling) return true;
  return steps_of(part.kind).does == operation;
}

// Builds as many parts of each kind as begin an operation in one cycle of the schedule.
inline void build_for(Datapath& path, const std::vector<LaneStep>& steps,
                      const FoldedSchedule& schedule, std::uint32_t interval_cycles) {
  for (BesideLanes& part : path.beside) {
    std::vector<std::uint32_t> begun(interval_cycles);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].begins == BesideLane::kNone || !does(part, steps[i].begins)) continue;
      std::uint32_t& in_cycle = begun[schedule.begins[i] % interval_cycles];
      part.built_for = std::max(part.built_for, ++in_cycle);
    }
  }
}

// Lanes, copies and charge must be what they will be. value_bits: of a value between two steps.
// Throws std::logic_error where the steps take more lanes than there are, unless the charge is a
// published one, which may be less than was counted.
inline void schedule(Datapath& path, const std::vector<LaneStep>& steps,
                     const OperationLatencies& latencies, std::uint32_t value_bits = kSingleBits) {
  const auto interval = static_cast<std::uint32_t>(path.interval_cycles());
  const FoldedPipeline folded = folded_pipeline(steps, parts_of(path, interval), latencies);
  if (path.used_macs == path.counted_macs && folded.parts.lanes > path.lanes) {
    throw std::logic_error(path.name + ": its steps take more lanes than are charged");
  }
  build_for(path, steps, folded.schedule, interval);
  path.between = between_lanes(folded.wiring, value_bits);
  path.depth_cycles = folded.schedule.cycles;
  path.loops = folded.schedule.loops;
}

// Registers for the constants of the steps: of the group that is worked on and of the next, which
// is set meanwhile; each copy takes the one or the other, since items of both may be under way.
// Those of the code itself, wires, are counted among them.
inline void set_by_group(Datapath& path, const std::vector<LaneStep>& steps) {
  const std::uint32_t bits = kSingleBits * constants_of(steps);
  path.set_bits = 2 * bits;
  path.between.multiplexers += bits;
}

}  // namespace sgs
