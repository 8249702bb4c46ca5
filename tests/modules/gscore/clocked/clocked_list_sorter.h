// The sorting side of a tile sorter register by register: the second QSU, which takes three cycles
// from an entry's reading to its subset's row, the bitonic network, stepped itself, and the way
// out.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/gscore/stepped_bitonic.h"

namespace sgs::test {

struct SorterEntry {
  std::uint32_t key = 0, what = 0;
};
using SorterList = std::vector<SorterEntry>;

constexpr std::size_t kQsuPivots = 7;

// By how many of 7 keys an entry's reaches.
inline std::array<SorterList, kQsuPivots + 1> split_list(
    const SorterList& list, const std::array<std::uint32_t, kQsuPivots>& pivots) {
  std::array<SorterList, kQsuPivots + 1> subsets;
  for (const SorterEntry& entry : list) {
    const auto reaches = [&](std::uint32_t pivot) { return entry.key >= pivot; };
    subsets[std::count_if(pivots.begin(), pivots.end(), reaches)].push_back(entry);
  }
  return subsets;
}
inline std::pair<std::uint32_t, std::uint32_t> key_range(const SorterList& list) {
  const auto [least, greatest] =
      std::minmax_element(list.begin(), list.end(),
                          [](const SorterEntry& a, const SorterEntry& b) { return a.key < b.key; });
  return {least->key, greatest->key};
}
// Entries of the list (its first block, where it lies in memory) evenly apart; or the range of its
// keys in eight.
inline std::array<std::uint32_t, kQsuPivots> sample(const SorterList& list, std::size_t count) {
  std::array<std::uint32_t, kQsuPivots> pivots{};
  for (std::size_t k = 0; k < kQsuPivots; ++k) pivots[k] = list[(k + 1) * count / 8].key;
  return pivots;
}
inline std::array<std::uint32_t, kQsuPivots> eighths(const SorterList& list) {
  const auto [least, greatest] = key_range(list);
  const std::uint64_t keys = std::uint64_t{greatest} - least + 1;
  std::array<std::uint32_t, kQsuPivots> pivots{};
  for (std::size_t k = 0; k < kQsuPivots; ++k) {
    pivots[k] = static_cast<std::uint32_t>(least + (keys * (k + 1) + 7) / 8);
  }
  return pivots;
}

// A list on chip, or a mark: of a tile's end or, as a job, of the frame's.
struct LoadedList {
  bool is_mark = false;
  std::uint32_t tile = 0;
  std::uint64_t mark = 0;  // as it comes out
  SorterList entries;
};

class ClockedListSorter {
 public:
  explicit ClockedListSorter(std::size_t chunk_entries) : chunk_entries_(chunk_entries) {}

  // How many lists on chip have become free.
  template <class Finished, class WhatOf>
  std::uint32_t step(ClockedFifo<LoadedList>& loaded, ClockedFifo<std::uint64_t>& out,
                     const Finished& finished, const WhatOf& what_of) {
    if (busy_ > 0 && --busy_ > 0) return 0;
    if (!put_out(out, what_of)) return 0;
    std::uint32_t freed = 0;
    for (;;) {
      if (holds_list_ && !next_subset(finished)) {
        holds_list_ = false;
        ++freed;
      }
      if (holds_list_ || !loaded.can_take()) break;
      list_ = loaded.take();
      if (list_.is_mark) {
        begin_emission({{0, 0}}, 1);
        break;
      }
      holds_list_ = true;
      to_sort_.push_back({list_.entries, 0});
    }
    return freed;
  }

 private:
  struct Sublist {
    SorterList entries;
    std::uint32_t level;
  };

  // Of what is read in this cycle and the ones before one goes out.
  template <class WhatOf>
  bool put_out(ClockedFifo<std::uint64_t>& out, const WhatOf& what_of) {
    if (emits_.empty()) return true;
    if (!out.has_room()) {
      busy_ = 1;
      return false;
    }
    out.put(list_.is_mark ? list_.mark : what_of(list_.tile, emits_.front().what));
    emits_.pop_front();
    busy_ = emits_.empty() ? 0 : 1;
    return emits_.empty();
  }
  // reads: from one another, an entry's place first where it is not where it lies.
  void begin_emission(const SorterList& entries, std::uint32_t reads) {
    emits_.assign(entries.begin(), entries.end());
    busy_ += reads;
  }

  // False: nothing is left of the list.
  template <class Finished>
  bool next_subset(const Finished& finished) {
    if (finished(list_.tile)) to_sort_.clear();
    if (to_sort_.empty()) return false;
    Sublist next = std::move(to_sort_.back());
    to_sort_.pop_back();
    const auto [least, greatest] = key_range(next.entries);
    if (least == greatest) {
      begin_emission(next.entries, next.level == 0 ? 1 : 2);
    } else if (next.entries.size() <= chunk_entries_) {
      sort_chunk(next.entries);
    } else {
      split(next);
    }
    return true;
  }
  void sort_chunk(const SorterList& entries) {
    std::vector<SteppedBitonic::Entry> keys;
    for (std::size_t at = 0; at < entries.size(); ++at) {
      keys.push_back(std::uint64_t{entries[at].key} << 32 | at);
    }
    SteppedBitonic network(keys);
    SorterList sorted;
    for (const SteppedBitonic::Entry entry : network.run()) {
      sorted.push_back(entries[static_cast<std::uint32_t>(entry)]);
    }
    busy_ = static_cast<std::uint32_t>(network.cycles());
    begin_emission(sorted, 2);
  }
  // An entry is read, its subset found while that one's row is read, the row written: so the places
  // begin a cycle behind the count, and what follows two behind the last entry.
  void split(const Sublist& list) {
    const auto entries = static_cast<std::uint32_t>(list.entries.size());
    constexpr std::uint32_t kRowOfLast = 1, kPlaceOfLast = 2;
    for (const std::uint32_t cycles : {std::uint32_t{kQsuPivots}, entries, kRowOfLast,
                                       std::uint32_t{kQsuPivots + 1}, entries, kPlaceOfLast}) {
      busy_ += cycles;
    }
    const auto subsets =
        split_list(list.entries, list.level == 0 ? sample(list.entries, list.entries.size())
                                                 : eighths(list.entries));
    for (std::size_t s = subsets.size(); s-- > 0;) {
      if (!subsets[s].empty()) to_sort_.push_back({subsets[s], list.level + 1});
    }
  }

  const std::size_t chunk_entries_;
  LoadedList list_;
  bool holds_list_ = false;
  std::vector<Sublist> to_sort_;  // the next one last
  std::deque<SorterEntry> emits_;
  std::uint32_t busy_ = 0;  // cycles until its result is there
};

}  // namespace sgs::test
