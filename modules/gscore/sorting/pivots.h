// The 7 keys by which a quick sorting unit splits a list into 8 subsets: an entry's subset is the
// number of pivots that its key reaches, so that they need no order of their own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/memory/tile_records.h"

namespace sgs::gscore {

constexpr std::uint32_t kPivots = 7, kSubsets = kPivots + 1;
using Pivots = std::array<std::uint32_t, kPivots>;

inline std::uint32_t subset_of(const Pivots& pivots, std::uint32_t key) {
  std::uint32_t subset = 0;
  for (const std::uint32_t pivot : pivots) subset += key >= pivot ? 1 : 0;
  return subset;
}

// Keys of a list, from the least to the greatest.
struct KeyRange {
  std::uint32_t least = ~0U, greatest = 0;
  void take(std::uint32_t key) {
    least = key < least ? key : least;
    greatest = key > greatest ? key : greatest;
  }
  bool single() const { return least >= greatest; }
};

// Keys of entries that lie evenly among the first `count` of these, at least one.
inline Pivots sampled_pivots(const std::vector<TileEntry>& entries, std::size_t count) {
  Pivots pivots{};
  for (std::size_t k = 0; k < kPivots; ++k) pivots[k] = entries[(k + 1) * count / kSubsets].key;
  return pivots;
}

// They cut the range evenly: each subset's range is an eighth, so that the splitting ends.
inline Pivots ranged_pivots(const KeyRange& range) {
  Pivots pivots{};
  const std::uint64_t span = std::uint64_t{range.greatest} - range.least + 1;
  for (std::uint64_t k = 0; k < kPivots; ++k) {
    pivots[k] =
        range.least + static_cast<std::uint32_t>((span * (k + 1) + kSubsets - 1) / kSubsets);
  }
  return pivots;
}

// Adders that count subsets' entries and compute pivots of a range, one pivot a cycle: a step of it
// more, and its least key on top.
constexpr std::uint32_t kPivotAdders = 2;
// A pivot is read or computed a cycle; a subset's place follows from those before it, one a cycle.
constexpr std::uint32_t kPivotCycles = kPivots, kSubsetPlaceCycles = kSubsets;
// An entry is read in one cycle; in the next its subset is found and the subset's row read; in the
// third the row and the entry's place are written. So the places follow from the rows one cycle
// behind the last entry's reading, and the step behind the last entry waits for two.
constexpr std::uint32_t kSubsetRowCycles = 1, kSubsetWriteCycles = 2;

// Levels of splitting at most: one by samples, then three bits of the range each.
constexpr std::uint32_t most_levels(NumberFormat keys) {
  return 1 + ((keys == NumberFormat::kHalf ? 16U : 32U) + 2) / 3;
}

}  // namespace sgs::gscore
