// Parts and accesses of an interval heap (algorithm/order/interval_heap.h), for the data sheet of
// its unit. Each level is a use of on-chip memory by itself; the root's level is 0. A word is a
// node: two keys and its two counts. Each level compares two pairs of keys, each with key_words
// comparators of 32 bits.
//
// Between the memories, a level, with keys of K bits and nodes of N; `heap_bit` is a bit of these
// multiplexers with its part of what else the level's gates are:
//   - registers for the key that sinks and for the node that waits to be written: K + N
//   - multiplexers for keys that an insert swaps at either end and that a hole takes: 7 K
//   - multiplexers for words read: a word written in the same cycle passes by each bank; two of the
//     four that are read ahead go on; one of the two that are compared rises
//
// Level l is a memory of its own of at most 2^l nodes, spread over banks of a read and a write port
// each. A hole is filled from the level below, so two neighbouring levels serve one operation.
//   - Another may begin every second cycle if a hole sinks a level a cycle. While the candidates
//     for it are compared, the children of both are read, up to four nodes of one level: four
//     banks, by the side of the candidate and that of its child. The operation before writes that
//     level in the same cycle, so a node that is read as it is written is what is written.
//   - With two banks, left and right children, reads wait for the comparison: a hole sinks a level
//     in two cycles, and another operation may begin every third.
// tests/modules/streaminggs/stepped_heap.h goes through both cycle by cycle. The heap is emptied in
// one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "algorithm/order/interval_heap.h"
#include "modules/streaminggs/built_for.h"
#include "tlm/data_sheet.h"

namespace sgs {

// Cycles from one operation to the next, at least.
constexpr std::uint32_t kFewestHeapCycles = 2;
// Banks of a level, where an operation begins every so many cycles.
constexpr std::uint32_t heap_banks_of_level(std::uint32_t cycles_per_operation) {
  return cycles_per_operation == kFewestHeapCycles ? 4 : 2;
}

struct HeapLedger {
  const char* keys;  // the uses are named so, and by their level
  const char* component;
  std::uint32_t key_bytes;
  std::uint32_t key_words;  // words of a key that are compared

  SramUses sram_uses(std::uint32_t entries, std::uint32_t cycles_per_operation) const {
    SramUses uses;
    for (std::uint32_t level = 0; level < heap_levels(entries); ++level) {
      const std::uint32_t bits = node_bits(entries, level);
      const std::uint32_t banks = banks_of(entries, level, cycles_per_operation);
      // Each bank at most once: that is what paces the operations.
      uses.push_back(sram_use(name_of(level).c_str(), kSharedSram,
                              {{(heap_nodes(entries, level) * bits + 7) / 8, "B"}},
                              {bits, SramPorts::kReadAndWrite, banks}, {banks, banks}));
    }
    return uses;
  }

  void publish(DataSheet& sheet, std::uint32_t entries, std::uint32_t cycles_per_operation,
               const HeapWork& work) const {
    constexpr std::uint32_t kOfLevel = 2;
    const bool ahead = cycles_per_operation == kFewestHeapCycles;
    double registers = 0, multiplexers = 0, registered = 0, selected = 0;
    for (std::uint32_t level = 0; level < heap_levels(entries); ++level) {
      const HeapLevelWork& of = work.levels[level];
      // The root is read and written by each operation.
      const std::uint64_t root = level == 0 ? work.operations() : 0;
      const std::uint64_t passes = root + of.nodes_written;
      sheet.accesses(name_of(level).c_str(),
                     root + of.nodes_read + (ahead ? of.nodes_read_ahead : 0), passes);
      const double held = 8.0 * key_bytes + node_bits(entries, level);
      const double words = words_chosen(entries, level, cycles_per_operation);
      const double chosen = 7 * 8.0 * key_bytes + words * node_bits(entries, level);
      registers += held;
      multiplexers += chosen;
      registered += held * static_cast<double>(passes);
      selected += chosen * static_cast<double>(passes);
    }
    sheet.part(component, "register_bit", registers, 1);
    sheet.operations(component, "register_bit", registered);
    sheet.part(component, "heap_bit", multiplexers, 1);
    sheet.operations(component, "heap_bit", selected);
    sheet.part(component, "comparator", double{kOfLevel} * key_words * heap_levels(entries), 1);
    sheet.operations(component, "comparator",
                     static_cast<double>(key_words) * static_cast<double>(work.comparisons));
  }

  std::string name_of(std::uint32_t level) const {
    return std::string(keys) + " " + std::to_string(level);
  }

 private:
  std::uint32_t node_bits(std::uint32_t entries, std::uint32_t level) const {
    return 2 * (8 * key_bytes + heap_count_bits(entries, level));
  }
  static std::uint32_t banks_of(std::uint32_t entries, std::uint32_t level,
                                std::uint32_t cycles_per_operation) {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(
        heap_nodes(entries, level), heap_banks_of_level(cycles_per_operation)));
  }
  // Words of a level's that two-way multiplexers choose; the root is alone and there at all times.
  static std::uint32_t words_chosen(std::uint32_t entries, std::uint32_t level,
                                    std::uint32_t cycles_per_operation) {
    constexpr std::uint32_t kCompared = 2, kRiser = 1;
    const std::uint32_t banks = banks_of(entries, level, cycles_per_operation);
    if (level == 0) return 0;
    return banks + (banks > kCompared ? kCompared : 0) + kRiser;
  }
};

}  // namespace sgs
