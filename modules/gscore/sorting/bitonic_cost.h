// A 16-wide bitonic network that sorts blocks of 16 and merges sorted runs 8 entries at a time: its
// cycles and what passes it. Keys with their places go through it, from one memory to another: each
// run lies there in order, so that 8 of its entries are in 8 banks.
//
// Blocks come from their list, one a cycle, pass all stages and are written to the first of two
// memories. Then runs are merged in pairs, level by level, from one memory to the other. Up to four
// pairs are merged side by side: each has its turn in the network's last four stages every fourth
// cycle, when the farther half of what its turn before gave has come to their end. A turn takes 8
// entries of that run of the two whose last taken entry is nearer, gives the nearer 8 and keeps the
// others; the first gives nothing, the last all. A run without another is copied so.
#pragma once

#include <algorithm>
#include <cstdint>

namespace sgs::gscore {

constexpr std::uint32_t kNetworkWidth = 16, kMergeWidth = kNetworkWidth / 2;
constexpr std::uint32_t kSortStages = 10, kMergeStages = 4;  // stages of 8 compare-exchanges
constexpr std::uint32_t kNetworkExchanges = kSortStages * kMergeWidth;

struct BitonicCost {
  std::uint64_t cycles = 0, compare_exchanges = 0;
  std::uint64_t merged = 0;  // entries, once for each level
};

// Cycles from the first block or turn of a level to its last entry's write: a cycle to read, one a
// stage, one to write.
constexpr std::uint64_t network_cycles(std::uint64_t last_begin, std::uint32_t stages) {
  return last_begin + 1 + stages + 1;
}

// Cost of a chunk; one entry costs nothing.
constexpr BitonicCost bitonic_cost(std::uint64_t entries) {
  BitonicCost cost;
  if (entries < 2) return cost;
  const std::uint64_t blocks = (entries + kNetworkWidth - 1) / kNetworkWidth;
  cost.cycles = network_cycles(blocks - 1, kSortStages);
  cost.compare_exchanges = blocks * kNetworkExchanges;
  for (std::uint64_t pair = 2 * kNetworkWidth; pair < 2 * entries; pair *= 2) {
    const std::uint64_t turns_of_whole = pair / kMergeWidth;
    std::uint64_t last_turn = 0;
    for (std::uint64_t first = 0, p = 0; first < entries; first += pair, ++p) {
      const std::uint64_t of_pair = std::min(pair, entries - first);
      const std::uint64_t turns = (of_pair + kMergeWidth - 1) / kMergeWidth;
      const std::uint64_t rounds = p / kMergeStages * turns_of_whole + turns - 1;
      last_turn = std::max(last_turn, rounds * kMergeStages + p % kMergeStages);
      const bool merges = of_pair > pair / 2;
      cost.compare_exchanges += merges ? (turns - 1) * kMergeStages * kMergeWidth : 0;
    }
    cost.cycles += network_cycles(last_turn, kMergeStages);
    cost.merged += entries;
  }
  return cost;
}

}  // namespace sgs::gscore
