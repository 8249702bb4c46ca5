// A datapath from what was counted by running its code.
#pragma once

#include "algorithm/splat/lane_macs.h"
#include "tlm/datapath.h"

namespace sgs {

// Single precision, charged with what was counted, one lane until it is said otherwise. Beside the
// lanes stand comparators, and tables: for what reciprocals, roots and logarithms start from, and
// for what the code looks up (rows: their kind).
inline Datapath counted_datapath(const char* name, const char* component, const OperationCounts& c,
                                 const char* rows = "small_table") {
  Datapath path;
  path.name = name;
  path.component = component;
  path.lane = "fp32_lane";
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
      {"comparator", comparisons(c)}, {"small_table", seeds(c)}, {rows, c.look_ups}};
  for (const auto& [kind, operations] : beside) {
    if (operations > 0) path.part_of(kind).operations += operations;
  }
  return path;
}

}  // namespace sgs
