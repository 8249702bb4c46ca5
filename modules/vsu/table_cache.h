// A small direct-mapped cache in front of a table of records in the modelled DRAM.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tlm/memory_access.h"

namespace sgs {

constexpr std::uint32_t kCacheLineBytes = 64;  // two bursts

// Record: trivially copyable, its size a divisor of the line's.
template <class Record>
class TableCache {
 public:
  static_assert(kCacheLineBytes % sizeof(Record) == 0);

  // The table's records are [base, base + count * sizeof(Record)); capacity is rounded down to
  // whole lines, at least one.
  TableCache(std::uint32_t capacity_bytes, std::uint64_t base, std::uint32_t count,
             std::uint8_t region)
      : base_(base),
        end_(base + std::uint64_t{count} * sizeof(Record)),
        region_(region),
        lines_(capacity_bytes < kCacheLineBytes ? 1 : capacity_bytes / kCacheLineBytes) {}

  // The record's bytes; on a miss the calling thread waits for DRAM.
  Record get(std::uint32_t index, MemoryPort& port, Activity& activity) {
    const std::uint64_t address = base_ + std::uint64_t{index} * sizeof(Record);
    const std::uint64_t tag = address / kCacheLineBytes;
    Line& line = lines_[tag % lines_.size()];
    if (line.tag != tag) {
      ++misses_;
      const std::uint64_t start = std::max(tag * kCacheLineBytes, base_);
      const std::uint64_t stop = std::min((tag + 1) * kCacheLineBytes, end_);
      await(port, activity,
            start_read(port, activity, start, line.bytes + (start - tag * kCacheLineBytes),
                       static_cast<std::uint32_t>(stop - start), region_));
      line.tag = tag;
    }
    Record record;
    std::memcpy(&record, line.bytes + address % kCacheLineBytes, sizeof record);
    return record;
  }

  std::uint64_t misses() const { return misses_; }

 private:
  struct Line {
    std::uint64_t tag = ~std::uint64_t{0};
    std::byte bytes[kCacheLineBytes];
  };
  const std::uint64_t base_, end_;
  const std::uint8_t region_;
  std::vector<Line> lines_;
  std::uint64_t misses_ = 0;
};

}  // namespace sgs
