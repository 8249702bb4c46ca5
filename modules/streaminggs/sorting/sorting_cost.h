// Cycles of a 16-wide bitonic network (Batcher, "Sorting networks and their applications", 1968)
// that sorts blocks of 16 and merges sorted runs 8 entries at a time.
#pragma once

#include <cstdint>

#include "modules/streaminggs/sorting/sorting_config.h"
#include "tlm/data_sheet.h"

namespace sgs {

constexpr std::uint32_t kNetworkWidth = 16;
constexpr std::uint32_t kMergeWidth = kNetworkWidth / 2;
constexpr std::uint32_t kSortStages = 10;  // log2(16) (log2(16) + 1) / 2
constexpr std::uint32_t kMergeStages = 4;  // log2(16)

// Levels of a binary merge tree over `runs` runs.
constexpr std::uint32_t merge_levels(std::uint64_t runs) {
  std::uint32_t levels = 0;
  while ((std::uint64_t{1} << levels) < runs) ++levels;
  return levels;
}

// Comparators that stand there: those of all stages where a block starts every cycle, folded where
// blocks or merges start less often.
constexpr std::uint32_t network_comparators(const SortingNetworkConfig& config) {
  const auto folded = [](std::uint32_t stages, std::uint32_t interval) {
    return (stages * kMergeWidth + interval - 1) / interval;
  };
  const std::uint32_t sort = folded(kSortStages, config.sort_interval_cycles);
  const std::uint32_t merge = folded(kMergeStages, config.merge_interval_cycles);
  return sort > merge ? sort : merge;
}

struct SortingCost {
  std::uint64_t cycles = 0;
  std::uint64_t compare_exchanges = 0;
  std::uint64_t moves = 0;  // entries read from the buffer, and written back
};

// Sorting n entries on chip. A list of 1 is in order already and need not pass; of 0 there is none.
constexpr SortingCost sort_cost(const SortingNetworkConfig& config, std::uint64_t n) {
  if (n == 0 || (n == 1 && config.skip_trivial)) return {};
  const std::uint64_t blocks = (n + kNetworkWidth - 1) / kNetworkWidth;
  const std::uint64_t merges = merge_levels(blocks) * ((n + kMergeWidth - 1) / kMergeWidth);
  return {config.sort_latency_cycles + blocks * config.sort_interval_cycles +
              merges * config.merge_interval_cycles,
          (blocks * kSortStages + merges * kMergeStages) * kMergeWidth,
          blocks * kNetworkWidth + merges * kMergeWidth};
}

// The network of a unit, or its share of one that serves several units in turn, and what it did so
// far.
inline void publish_network(DataSheet& sheet, const SortingNetworkConfig& config,
                            std::uint64_t compare_exchanges, std::uint32_t units_of_network = 1) {
  const double comparators = network_comparators(config);
  sheet.part("sorting", "compare_exchange", comparators / units_of_network, 1);
  sheet.operations("sorting", "compare_exchange", static_cast<double>(compare_exchanges));
}

// What lists of one entry spare, for the data sheet.
inline void publish_trivial_sorts(DataSheet& sheet, const SortingNetworkConfig& config,
                                  std::uint64_t lists) {
  sheet.left_out(
      "trivial_sorts", "a visit with one splat", lists,
      config.skip_trivial ? "a pass of the sorting network each" : "nothing: switched off");
}

}  // namespace sgs
