// The data sheets as a ledger: what was done was done by something that stands there and had the
// time for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/result/frame_result.h"

namespace sgs {

// What one kind of part, or the memories of one use, did of what they could have done.
struct LedgerLine {
  std::string what;      // "vsu: comparator", "chunk_test: busiest", "pixel state: reads"
  double done = 0;       // operations, cycles of the busiest unit's lanes, or accesses
  double per_cycle = 0;  // that all of them can do
  // Of the frame, 0 to 1: a closed form that bounds its cycles from below.
  double utilisation(std::uint64_t cycles) const;
};

// Lanes and other parts by component, each datapath by itself, and ports of memories.
std::vector<LedgerLine> ledger_of(const MachineResult& machine);

// What is wrong with it, in words; nothing in a machine that pays for all it does: a use of on-chip
// memory that nobody says the accesses of, accesses of no use, operations that no part does, more
// operations or accesses than the frame has time for, more accesses in one cycle than a memory has
// ports, banks that are smaller than a word, and a unit that was busy and charged nothing.
std::vector<std::string> ledger_faults(const MachineResult& machine, std::uint64_t cycles);

}  // namespace sgs
