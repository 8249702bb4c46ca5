// What an interval heap (algorithm/order/interval_heap.h) is made of and does, for the data sheet
// of the unit that has one. A node of two keys is a word, its two counts are one beside it; each
// bank of keys has its bank of counts. Two comparisons of keys a level, each of key_words
// comparators of 32 bits.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algorithm/order/interval_heap.h"
#include "modules/streaminggs/built_for.h"
#include "tlm/data_sheet.h"

namespace sgs {

struct HeapLedger {
  const char* keys;    // name of the use that holds them
  const char* counts;  // and of that of their counts
  const char* component;
  std::uint32_t key_bytes;
  std::uint32_t key_words;  // that are compared

  SramUses sram_uses(std::uint32_t entries, std::uint32_t cycles_per_operation) const {
    const std::uint32_t banks = heap_banks(entries, cycles_per_operation);
    const SramShape of_counts = count_shape(entries, cycles_per_operation);
    // Each bank at most once: that is what paces the operations.
    return {sram_use(keys, kSharedSram, {{entries, "keys"}, {key_bytes, "B"}},
                     {8 * 2 * key_bytes, SramPorts::kReadAndWrite, banks}, {banks, banks}),
            sram_use(counts, kSharedSram, {{(heap_count_bits(entries) + 7) / 8, "B"}}, of_counts,
                     {of_counts.banks, of_counts.banks})};
  }

  void publish(DataSheet& sheet, std::uint32_t entries, std::uint32_t cycles_per_operation,
               const HeapWork& work) const {
    constexpr std::uint32_t kOfLevel = 2;
    const bool ahead = cycles_per_operation == kFewestHeapCycles;
    const std::uint64_t read = work.nodes_read + (ahead ? work.nodes_read_ahead : 0);
    sheet.accesses(keys, read, work.nodes_written);
    sheet.accesses(counts, read, work.nodes_written);
    sheet.part(component, "comparator", double{kOfLevel} * key_words * heap_levels(entries), 1);
    sheet.operations(component, "comparator",
                     static_cast<double>(key_words) * static_cast<double>(work.comparisons));
  }

 private:
  // The deepest level has no counts; of the others each counts to what lies below it, so that its
  // words are narrower the deeper it lies: their mean width.
  static SramShape count_shape(std::uint32_t entries, std::uint32_t cycles_per_operation) {
    const std::uint32_t levels = heap_levels(entries);
    std::uint32_t banks = 0, bits = 0;
    for (std::uint32_t level = 0; level + 1 < levels; ++level) {
      const std::uint32_t here =
          std::min(1U << std::min(level, 31U), heap_banks_of_level(cycles_per_operation));
      banks += here;
      bits += here * 2 * (levels - level);
    }
    if (banks == 0) return {1};
    return {(2 * bits + banks) / (2 * banks), SramPorts::kReadAndWrite, banks};
  }
};

}  // namespace sgs
