// A small 4-way cache (least recently used goes) in front of a table of records in the modelled
// DRAM.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "algorithm/memory/scene_layout.h"
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

  struct Line {
    std::uint64_t tag = ~std::uint64_t{0};
    std::byte bytes[kCacheLineBytes] = {};
  };

  // The line that holds a record, and the record in it.
  std::uint64_t line_of(std::uint32_t index) const {
    return table_.address(index) / kCacheLineBytes;
  }
  Record record_in(const Line& line, std::uint32_t index) const {
    Record record;
    std::memcpy(&record, line.bytes + table_.address(index) % kCacheLineBytes, sizeof record);
    return record;
  }

  // The record's line, most recently used from now on; null where it is not there.
  const Line* find(std::uint32_t index) {
    ++lookups_;
    Set& set = set_of(line_of(index));
    const auto at = std::find_if(set.begin(), set.end(),
                                 [&](const Line& l) { return l.tag == line_of(index); });
    if (at == set.end()) return nullptr;
    std::rotate(set.begin(), at, at + 1);
    return &set.front();
  }

  // Starts to read a line that is not there; its bytes are in `into` when the ticket is done.
  MemoryPort::Ticket fetch(std::uint64_t tag, Line& into, MemoryPort& port, Activity& activity) {
    ++misses_;
    into.tag = tag;
    const std::uint64_t begin = tag * kCacheLineBytes;
    const std::uint64_t start = std::max(begin, table_.base);
    const std::uint64_t stop = std::min(begin + kCacheLineBytes, table_.end());
    return start_read(port, activity, start, into.bytes + (start - begin),
                      static_cast<std::uint32_t>(stop - start), table_.region);
  }

  // A line that has come takes the place of its set's least recently used.
  void fill(const Line& line) {
    Set& set = set_of(line.tag);
    set.back() = line;
    std::rotate(set.begin(), set.end() - 1, set.end());
  }

  // The record; on a miss the calling thread waits for DRAM.
  Record get(std::uint32_t index, MemoryPort& port, Activity& activity) {
    if (const Line* const line = find(index)) return record_in(*line, index);
    Line line;
    await(port, activity, fetch(line_of(index), line, port, activity));
    fill(line);
    return record_in(line, index);
  }

  std::uint64_t lookups() const { return lookups_; }
  std::uint64_t misses() const { return misses_; }

  // Its lines and their tags: the four ways of a set lie side by side, tags and age are read at
  // once.
  static SramUses sram_uses(const char* lines_name, const char* tags_name, const char* memory,
                            std::uint32_t capacity_bytes) {
    const std::uint32_t lines =
        kCacheWays * std::max(1U, capacity_bytes / (kCacheLineBytes * kCacheWays));
    return {sram_use(lines_name, memory, {{capacity_bytes, "B"}}, {8 * kPortBytes}, kOneOfEach),
            sram_use(tags_name, memory, {{lines, "lines"}, {kCacheTagBytes, "B"}},
                     {8 * kCacheTagBytes * kCacheWays}, kOneOfEach)};
  }
  // Publishes the reads and writes of lines and tags so far.
  void publish_accesses(DataSheet& sheet, const char* lines_name, const char* tags_name) const {
    const std::uint64_t line = sram_words(kCacheLineBytes, {8 * kPortBytes});
    sheet.accesses(lines_name, lookups_ * sram_words(sizeof(Record), {8 * kPortBytes}),
                   misses_ * line);
    sheet.accesses(tags_name, lookups_, lookups_);
  }

 private:
  using Set = std::array<Line, kCacheWays>;  // most recently used first

  Set& set_of(std::uint64_t tag) { return sets_[tag % sets_.size()]; }

  const RecordArray table_;
  std::vector<Set> sets_;
  std::uint64_t lookups_ = 0, misses_ = 0;
};

}  // namespace sgs
