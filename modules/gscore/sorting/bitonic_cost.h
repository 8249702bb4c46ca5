// A 16-wide bitonic network that sorts blocks of 16 and merges sorted runs 8 entries at a time: its
// cycles and what passes it. Keys and places go through it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace sgs::gscore {

constexpr std::uint32_t kNetworkWidth = 16, kMergeWidth = kNetworkWidth / 2;
constexpr std::uint32_t kSortStages = 10, kMergeStages = 4;  // of 8 compare-exchanges
// In, a stage a cycle, out.
constexpr std::uint32_t kNetworkLatency = kSortStages + 2;
constexpr std::uint32_t kNetworkExchanges = kSortStages * kMergeWidth;

struct BitonicCost {
  std::uint64_t cycles = 0, compare_exchanges = 0;
  std::uint64_t moves = 0;  // of entries through the network
};

// Of a chunk; of one entry nothing. The farther half of a merge goes into the next of the same
// pair of runs, so that a pair has one every kMergeStages cycles; pairs go side by side.
constexpr BitonicCost bitonic_cost(std::uint64_t entries) {
  BitonicCost cost;
  if (entries < 2) return cost;
  const std::uint64_t blocks = (entries + kNetworkWidth - 1) / kNetworkWidth;
  cost.cycles = kNetworkLatency + blocks;
  cost.compare_exchanges = blocks * kNetworkExchanges;
  cost.moves = blocks * kNetworkWidth;
  const std::uint64_t merges = (entries + kMergeWidth - 1) / kMergeWidth;
  for (std::uint64_t runs = blocks; runs > 1; runs = (runs + 1) / 2) {
    const std::uint64_t pairs = runs / 2;
    cost.cycles += kMergeStages + merges * ((kMergeStages + pairs - 1) / pairs);
    cost.compare_exchanges += merges * kMergeStages * kMergeWidth;
    cost.moves += merges * kMergeWidth;
  }
  return cost;
}

}  // namespace sgs::gscore
