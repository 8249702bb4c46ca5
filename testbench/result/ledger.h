// The data sheets as a ledger: what was done was done by something that stands there and had the
// time for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/result/frame_result.h"

namespace sgs {

// Operations or accesses done by one kind of part, or by the memories of one use, beside their
// limit.
struct LedgerLine {
  std::string what;      // "vsu: comparator", "chunk_test: busiest", "pixel state: reads"
  double done = 0;       // operations, cycles of the busiest unit's lanes, or accesses
  double per_cycle = 0;  // limit of all of them together
  // Share of the frame's capacity that was used, 0 to 1: a closed form that bounds the frame's
  // cycles from below.
  double utilisation(std::uint64_t cycles) const;
};

// Lanes and other parts by component, each datapath by itself, and ports of memories.
std::vector<LedgerLine> ledger_of(const MachineResult& machine);

// Faults of the ledger, in words; none in a machine that pays for all it does. They are: a use of
// on-chip memory that nobody says the accesses of; accesses of no use; operations that no part
// does; more operations or accesses than the frame has time for; more accesses in one cycle than a
// memory has ports; banks that are smaller than a word; and a unit that was busy and charged
// nothing.
std::vector<std::string> ledger_faults(const MachineResult& machine, std::uint64_t cycles);

}  // namespace sgs
