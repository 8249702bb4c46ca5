// A small 4-way cache (least recently used goes) in front of a table of records in the modelled
// DRAM.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "algorithm/memory/regions.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"

namespace sgs {

constexpr std::uint32_t kCacheWays = 4;
constexpr std::uint32_t kCacheTagBytes = 4;  // upper bits of the address, age within the set

// Record: trivially copyable, its size a power of two.
template <class Record>
class TableCache {
 public:
  // A burst of the memory: which records will be wanted next is not known well enough for more.
  static constexpr std::uint32_t kCacheLineBytes = std::max<std::uint32_t>(32, sizeof(Record));
  static_assert(kCacheLineBytes % sizeof(Record) == 0);

  // Capacity is rounded down to whole lines, at least one.
  TableCache(std::uint32_t capacity_bytes, const RecordArray& table)
      : table_(table), sets_(std::max(1U, capacity_bytes / (kCacheLineBytes * kCacheWays))) {}

  // The record's bytes; on a miss the calling thread waits for DRAM.
  Record get(std::uint32_t index, MemoryPort& port, Activity& activity) {
    ++lookups_;
    const std::uint64_t address = table_.address(index);
    const std::uint64_t tag = address / kCacheLineBytes;
    const Line& line = find_or_fetch(tag, port, activity);
    Record record;
    std::memcpy(&record, line.bytes + address % kCacheLineBytes, sizeof record);
    return record;
  }

  std::uint64_t lookups() const { return lookups_; }
  std::uint64_t misses() const { return misses_; }

  // Its lines and their tags: the four ways of a set lie side by side, tags and age are read at
  // once.
  static SramUses sram_uses(const char* lines_name, const char* tags_name, const char* memory,
                            std::uint32_t capacity_bytes) {
    const std::uint32_t lines =
        kCacheWays * std::max(1U, capacity_bytes / (kCacheLineBytes * kCacheWays));
    return {sram_use(lines_name, memory, {{capacity_bytes, "B"}}, {8 * kPortBytes}),
            sram_use(tags_name, memory, {{lines, "lines"}, {kCacheTagBytes, "B"}},
                     {8 * kCacheTagBytes * kCacheWays})};
  }
  // What was read and written of both so far.
  void publish_accesses(DataSheet& sheet, const char* lines_name, const char* tags_name) const {
    const std::uint64_t line = sram_words(kCacheLineBytes, {8 * kPortBytes});
    sheet.accesses(lines_name, lookups_ * sram_words(sizeof(Record), {8 * kPortBytes}),
                   misses_ * line);
    sheet.accesses(tags_name, lookups_, lookups_);
  }

 private:
  struct Line {
    std::uint64_t tag = ~std::uint64_t{0};
    std::byte bytes[kCacheLineBytes];
  };
  using Set = std::array<Line, kCacheWays>;  // most recently used first

  const Line& find_or_fetch(std::uint64_t tag, MemoryPort& port, Activity& activity) {
    Set& set = sets_[tag % sets_.size()];
    auto at = std::find_if(set.begin(), set.end(), [&](const Line& l) { return l.tag == tag; });
    if (at == set.begin()) return *at;
    if (at == set.end()) {
      ++misses_;
      --at;
      const std::uint64_t start = std::max(tag * kCacheLineBytes, table_.base);
      const std::uint64_t stop = std::min((tag + 1) * kCacheLineBytes, table_.end());
      await(port, activity,
            start_read(port, activity, start, at->bytes + (start - tag * kCacheLineBytes),
                       static_cast<std::uint32_t>(stop - start), table_.region));
      at->tag = tag;
    }
    std::rotate(set.begin(), at, at + 1);
    return set.front();
  }

  const RecordArray table_;
  std::vector<Set> sets_;
  std::uint64_t lookups_ = 0, misses_ = 0;
};

}  // namespace sgs
