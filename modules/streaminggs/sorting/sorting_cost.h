// A 16-wide bitonic network (Batcher, "Sorting networks and their applications", 1968) that sorts
// blocks of 16 and merges sorted runs 8 entries at a time: its cycles, comparators and memories.
// Through it go keys and their places; what else an entry has stays where it came to lie.
#pragma once

#include <algorithm>
#include <cstdint>

#include "modules/streaminggs/sorting/sorting_config.h"
#include "tlm/data_sheet.h"

namespace sgs {

constexpr std::uint32_t kNetworkWidth = 16;
constexpr std::uint32_t kMergeWidth = kNetworkWidth / 2;
constexpr std::uint32_t kSortStages = 10;  // log2(16) (log2(16) + 1) / 2
constexpr std::uint32_t kMergeStages = 4;  // log2(16)
// Latency of a merge, in cycles: read, through the stages, written. A level of the tree begins when
// the last merge of the one before is written.
constexpr std::uint32_t kMergeLatency = 1 + kMergeStages + 1;

// The key that is compared: depth, then slot. A comparator of the technology table has 32 bits.
constexpr std::uint32_t kSortKeyBytes = 8;
constexpr std::uint32_t kSortKeyComparators = 8 * kSortKeyBytes / 32;

// Levels of a binary merge tree over `runs` runs.
constexpr std::uint32_t merge_levels(std::uint64_t runs) {
  std::uint32_t levels = 0;
  while ((std::uint64_t{1} << levels) < runs) ++levels;
  return levels;
}

// Turns of the network between two merges of the same pair of runs: the second takes the farther
// half that the first gives. turn: cycles.
constexpr std::uint64_t turns_to_next_merge(std::uint64_t turn) {
  return (kMergeStages + turn - 1) / turn;
}

// Cycles in which kMergeWidth entries pass all levels, of long runs. `lists` take turns in the
// network; pairs of runs go side by side.
constexpr std::uint64_t merge_tree_cycles(const SortingNetworkConfig& config, std::uint64_t runs,
                                          std::uint32_t lists = 1) {
  const std::uint64_t turn = std::uint64_t{lists} * config.merge_interval_cycles;
  const std::uint64_t of_a_pair = turns_to_next_merge(turn);
  std::uint64_t cycles = 0;
  for (; runs > 1; runs = (runs + 1) / 2) {
    const std::uint64_t pairs = runs / 2;
    cycles += turn * ((of_a_pair + pairs - 1) / pairs);
  }
  return cycles;
}

// Turns from the first merge of a level to its last, both counted: n entries in runs of `run`, the
// last one shorter. Either every turn is taken, or what takes longest are the merges of the longest
// pairs, one behind the other. A run without another goes into the other list in any turn.
constexpr std::uint64_t merge_level_turns(std::uint64_t n, std::uint64_t run, std::uint64_t turn) {
  const auto merges = [](std::uint64_t entries) {
    return (entries + kMergeWidth - 1) / kMergeWidth;
  };
  const std::uint64_t whole = n / (2 * run), rest = n % (2 * run);
  const std::uint64_t longest = merges(whole > 0 ? 2 * run : rest);
  const std::uint64_t as_long = whole + (rest > run && merges(rest) == longest ? 1 : 0);
  return std::max(merges(n), (longest - 1) * turns_to_next_merge(turn) + as_long);
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
  std::uint64_t moves = 0;  // entries moved through the network: keys read, places written
};

// Sorting n entries on chip; each of the other lists that share the network has a turn before every
// turn of this one. A list of 1 is in order already and need not pass; of 0 there is none.
constexpr SortingCost sort_cost(const SortingNetworkConfig& config, std::uint64_t n,
                                std::uint32_t lists = 1) {
  if (n == 0 || (n == 1 && config.skip_trivial)) return {};
  const std::uint64_t blocks = (n + kNetworkWidth - 1) / kNetworkWidth;
  const std::uint64_t turn = std::uint64_t{lists} * config.merge_interval_cycles;
  std::uint64_t cycles =
      (lists * blocks - 1) * config.sort_interval_cycles + config.sort_latency_cycles;
  std::uint64_t merges = 0;
  for (std::uint64_t run = kNetworkWidth; run < n; run *= 2) {
    cycles += (lists * merge_level_turns(n, run, turn) - 1) * config.merge_interval_cycles +
              kMergeLatency;
    merges += (n + kMergeWidth - 1) / kMergeWidth;
  }
  return {cycles, (blocks * kSortStages + merges * kMergeStages) * kMergeWidth,
          blocks * kNetworkWidth + merges * kMergeWidth};
}

// Bits of the place of one of so many entries on chip.
constexpr std::uint32_t place_bits(std::uint64_t entries) {
  std::uint32_t bits = 1;
  while ((std::uint64_t{1} << bits) < entries) ++bits;
  return bits;
}

// Bits that a compare-exchange moves of each of its two entries: the key and its place.
constexpr std::uint32_t exchanged_bits(std::uint64_t entries) {
  return 8 * kSortKeyBytes + place_bits(entries);
}

// Multiplexers of two that a key passes from its bank to its place before the network. Where lists
// are merged, the keys that come next lie in any banks; a block lies in all of them, in order.
constexpr std::uint32_t kKeySelections = 4;  // log2(16)

// Publishes the network of a unit with room for so many entries, or its share of one that serves
// several units in turn; and its operations so far. moves: as of sort_cost.
inline void publish_network(DataSheet& sheet, const SortingNetworkConfig& config,
                            std::uint64_t entries, std::uint64_t compare_exchanges,
                            std::uint64_t moves, std::uint32_t units_of_network = 1) {
  const double there = static_cast<double>(network_comparators(config)) / units_of_network;
  const auto done = static_cast<double>(compare_exchanges);
  sheet.part("sorting", "comparator", kSortKeyComparators * there, 1);
  sheet.operations("sorting", "comparator", kSortKeyComparators * done);
  sheet.part("sorting", "exchange_bit", exchanged_bits(entries) * there, 1);
  sheet.operations("sorting", "exchange_bit", exchanged_bits(entries) * done);
  if (entries <= kNetworkWidth) return;
  const std::uint32_t selected = kMergeWidth * (kNetworkWidth - 1) * exchanged_bits(entries);
  sheet.part("sorting", "select_bit", static_cast<double>(selected) / units_of_network, 1);
  sheet.operations(
      "sorting", "select_bit",
      static_cast<double>(kKeySelections) * exchanged_bits(entries) * static_cast<double>(moves));
}

constexpr const char* kComparedKeys = "compared keys";
constexpr const char* kSortedPlaces = "sorted places";

// Memories of a unit that sorts so many entries: keys, the rest of each entry (`rest`), and lists
// of places. There is a second list where runs are merged from one into the other. The network
// takes 16 keys and places at once, so these have as many banks.
inline SramUses sort_memories(const char* rest, const char* memory, std::uint32_t entries,
                              std::uint32_t entry_bytes) {
  const std::uint32_t banks = std::min(entries, kNetworkWidth);
  const std::uint32_t rest_bytes = entry_bytes - kSortKeyBytes;
  const std::uint32_t place_bytes = (place_bits(entries) + 7) / 8;
  const std::uint32_t lists = entries > kNetworkWidth ? 2 : 1;
  constexpr auto kPorts = SramPorts::kReadAndWrite;
  return {
      sram_use(rest, memory, {{entries, "entries"}, {rest_bytes, "B"}}, {8 * rest_bytes},
               kOneOfEach),
      sram_use(kComparedKeys, memory, {{entries, "keys"}, {kSortKeyBytes, "B"}},
               {8 * kSortKeyBytes, kPorts, banks}, {banks, 1}),
      sram_use(kSortedPlaces, memory, {{lists, "lists"}, {entries, "places"}, {place_bytes, "B"}},
               {8 * place_bytes, kPorts, banks}, {banks, banks})};
}

// entries: each came in and went out once, key and rest, at its place. moves: keys and their places
// that the network read, and places that it wrote.
inline void publish_sort_accesses(DataSheet& sheet, const char* rest, std::uint64_t entries,
                                  std::uint64_t moves) {
  sheet.accesses(rest, entries, entries);
  sheet.accesses(kComparedKeys, entries + moves, entries);
  sheet.accesses(kSortedPlaces, entries + moves, moves);
}

// Publishes the passes that lists of one entry spare.
inline void publish_trivial_sorts(DataSheet& sheet, const SortingNetworkConfig& config,
                                  std::uint64_t lists) {
  sheet.left_out("trivial_sorts", "a visit with one splat", config.skip_trivial ? lists : 0,
                 "a pass of the sorting network each");
}

}  // namespace sgs
