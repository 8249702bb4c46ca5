// Cycles of the ordering table (algorithm/order/ordering_table.h), whose words lie in banks in
// turn. Each word read names the next one, so that one comes a cycle, one behind the other.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algorithm/order/ordering_table.h"

namespace sgs {

// Cycles to read for voxels that rays met: the hash's slot (beside it the record of the voxel
// before), the record that it names, the edges of the voxel before.
inline std::uint64_t meeting_cycles(const OrderingAccesses& before, const OrderingAccesses& after) {
  return (after.met - before.met) + (after.reads - before.reads) -
         (after.heads_read - before.heads_read);
}

// Cycles to write the words of the voxel added last: to the banks, beside the reads for the next
// voxel, which see words still to be written.
inline std::uint64_t writing_cycles(const OrderingTable& table, std::uint32_t banks) {
  std::uint64_t cycles = table.ready_written();
  const auto& words = table.written();
  for (const std::uint32_t of : words) {
    const auto in_bank = std::count_if(
        words.begin(), words.end(), [&](std::uint32_t word) { return word % banks == of % banks; });
    cycles = std::max(cycles, static_cast<std::uint64_t>(in_bank));
  }
  return cycles;
}

// Cycles to order all voxels: a level of ready voxels is read a cycle, then the voxel's record,
// then its edges. The record that an edge names is read beside the next edge, unless both lie in
// one bank.
inline std::uint64_t ordering_cycles(const OrderingTable& table, std::uint32_t banks) {
  std::uint64_t cycles = 0;
  for (std::uint32_t number = 0; number < table.voxel_count(); ++number) {
    cycles += table.ready_levels() + 1;
    bool first = true;
    std::uint32_t named = 0;  // record that the edge before names
    table.for_each_edge(number, [&](std::uint32_t word, std::uint32_t successor) {
      // The record that the last edge names is read behind all: counted with the first.
      cycles += first || named % banks == word % banks ? 2 : 1;
      first = false;
      named = successor;
    });
  }
  return cycles;
}

}  // namespace sgs
