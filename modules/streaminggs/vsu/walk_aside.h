// Entries of the walk's queues that do not fit them, in an area of DRAM: what ChunkWalk
// (algorithm/order/chunk_walk.h) calls its source.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/memory/regions.h"
#include "algorithm/order/walk_queue.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "tlm/memory_access.h"

namespace sgs {

// Of the thread that walks: its activity waits, and its port is charged to the group that it is at.
class WalkAside {
 public:
  WalkAside(MemoryPort& port, Activity& walk, const RegionSpan& span)
      : port_(port), walk_(walk), span_(span) {}

  void put_aside(const WalkEntry& entry) {
    static_assert(sizeof(WalkEntry) == kWalkEntryBytes);
    start_write(port_, walk_, span_.base + std::uint64_t{count_} * kWalkEntryBytes, &entry,
                kWalkEntryBytes, span_.region);
    ++count_;
  }

  std::vector<WalkEntry> take_back() {
    std::vector<WalkEntry> entries(count_);
    await_all(port_, walk_);  // they have been written
    await(port_, walk_,
          start_read(port_, walk_, span_.base, entries.data(), count_ * kWalkEntryBytes,
                     span_.region));
    count_ = 0;
    return entries;
  }

  void forget_aside() {
    await_all(port_, walk_);  // or they could overtake the next group's
    count_ = 0;
  }

 private:
  MemoryPort& port_;
  Activity& walk_;
  const RegionSpan span_;
  std::uint32_t count_ = 0;
};

}  // namespace sgs
