// What an interval heap (algorithm/order/interval_heap.h) is made of and does, for the data sheet of
// the unit that has one. Level l is a memory of at most 2^l nodes of two keys, beside it their
// counts; both children of a node are read at once. Two comparisons of keys a level, each of
// key_words comparators of 32 bits.
#pragma once

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

  // Left and right children, so that those of one node are read at once.
  static constexpr std::uint32_t kBanksOfLevel = 2;

  SramUses sram_uses(std::uint32_t entries) const {
    const std::uint32_t levels = heap_levels(entries);
    return {sram_use(keys, kSharedSram, {{entries, "keys"}, {key_bytes, "B"}},
                     {8 * 2 * key_bytes, SramPorts::kReadAndWrite, kBanksOfLevel * levels}),
            sram_use(counts, kSharedSram, {{(heap_count_bits(entries) + 7) / 8, "B"}},
                     {32, SramPorts::kReadAndWrite, levels})};
  }

  void publish(DataSheet& sheet, std::uint32_t entries, const HeapWork& work) const {
    constexpr std::uint32_t kOfLevel = 2;
    sheet.accesses(keys, 2 * work.words_read, work.nodes_written);
    sheet.accesses(counts, work.words_read, work.nodes_written);
    sheet.part(component, "comparator", double{kOfLevel} * key_words * heap_levels(entries), 1);
    sheet.operations(component, "comparator",
                     static_cast<double>(key_words) * static_cast<double>(work.comparisons));
  }
};

}  // namespace sgs
