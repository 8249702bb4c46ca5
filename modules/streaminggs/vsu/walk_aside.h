// Entries of the walk's queues that do not fit them, in an area of DRAM: what ChunkWalk
// (algorithm/order/chunk_walk.h) calls its source.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/order/walk_queue.h"
#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"

namespace sgs {

// Used by the thread that walks: its activity waits, and its port is charged to the group that the
// walk is at.
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

  // Takes entries back by blocks. Entries put aside meanwhile take the place of those that have
  // come back.
  template <class To>
  void take_back(const To& to) {
    await_all(port_, walk_);  // they have been written
    const std::uint32_t count = std::exchange(count_, 0);
    for (std::uint32_t first = 0; first < count; first += kBlockEntries) {
      WalkEntry block[kBlockEntries];
      const std::uint32_t entries = std::min(kBlockEntries, count - first);
      await(port_, walk_,
            start_read(port_, walk_, span_.base + std::uint64_t{first} * kWalkEntryBytes, block,
                       entries * kWalkEntryBytes, span_.region));
      words_come_ += sram_words(std::uint64_t{entries} * kWalkEntryBytes, {8 * kPortBytes});
      std::for_each(block, block + entries, to);
    }
    taken_back_ += count;
  }

  void forget_aside() {
    await_all(port_, walk_);  // or they could overtake the next group's
    count_ = 0;
  }

  static SramUse sram_use_of_block() {
    return sram_use(kComeBack, kSharedSram, {{kBlockEntries, "entries"}, {kWalkEntryBytes, "B"}},
                    {8 * kPortBytes}, kOneOfEach);
  }
  void publish(DataSheet& sheet) const { sheet.accesses(kComeBack, taken_back_, words_come_); }

 private:
  static constexpr std::uint32_t kBlockEntries = 16;
  static constexpr const char* kComeBack = "entries that come back";

  MemoryPort& port_;
  Activity& walk_;
  const RegionSpan span_;
  std::uint32_t count_ = 0;
  std::uint64_t taken_back_ = 0, words_come_ = 0;
};

}  // namespace sgs
