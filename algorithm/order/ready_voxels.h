// Which voxels of the ordering table wait for no other: a bit each, in words, above them a bit for
// each word that has any, and so on up to one word. The first is found from the top, a word a
// level.
#pragma once

#include <cstdint>
#include <vector>

namespace sgs {

class ReadyVoxels {
 public:
  static constexpr std::uint32_t kWordBits = 32;

  // Levels of words over so many voxels, the bits themselves included.
  static std::uint32_t levels_for(std::uint64_t voxels) {
    std::uint32_t levels = 1;
    for (; voxels > kWordBits; voxels = words_for(voxels)) ++levels;
    return levels;
  }
  // Words of all levels.
  static std::uint64_t all_words_for(std::uint64_t voxels) {
    std::uint64_t sum = words_for(voxels);
    for (; voxels > kWordBits; voxels = words_for(voxels)) sum += words_for(words_for(voxels));
    return sum;
  }

  explicit ReadyVoxels(std::uint64_t voxels) {
    for (std::uint64_t bits = voxels;; bits = words_for(bits)) {
      words_.emplace_back(words_for(bits), 0);
      if (bits <= kWordBits) break;
    }
  }

  std::uint32_t levels() const { return static_cast<std::uint32_t>(words_.size()); }
  bool empty() const { return words_.back().front() == 0; }

  // Each returns how many words it has read and written: one of each level that changes.
  std::uint32_t set(std::uint32_t voxel) {
    std::uint32_t written = 0, at = voxel;
    for (auto& level : words_) {
      std::uint32_t& word = level[at / kWordBits];
      const bool was_empty = word == 0;
      word |= 1U << at % kWordBits;
      ++written;
      if (!was_empty) break;
      at /= kWordBits;
    }
    return written;
  }
  std::uint32_t clear(std::uint32_t voxel) {
    std::uint32_t written = 0, at = voxel;
    for (auto& level : words_) {
      std::uint32_t& word = level[at / kWordBits];
      word &= ~(1U << at % kWordBits);
      ++written;
      if (word != 0) break;
      at /= kWordBits;
    }
    return written;
  }

  // The lowest; not where there is none.
  std::uint32_t first() const {
    std::uint32_t at = 0;
    for (std::size_t level = words_.size(); level-- > 0;) {
      at = at * kWordBits + static_cast<std::uint32_t>(__builtin_ctz(words_[level][at]));
    }
    return at;
  }

 private:
  static std::uint64_t words_for(std::uint64_t bits) { return (bits + kWordBits - 1) / kWordBits; }

  std::vector<std::vector<std::uint32_t>> words_;  // [level], the bits first
};

}  // namespace sgs
