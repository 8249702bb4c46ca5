// Which voxel has which number in the ordering table: a hash table of numbers with linear probing.
// A slot holds a number only; whose it is stands in the ordering table itself.
#pragma once

#include <cstdint>
#include <vector>

namespace sgs {

class Renaming {
 public:
  // Slots for so many voxels: a power of two, at most three quarters of them taken.
  static std::uint64_t slots_for(std::uint64_t voxels) {
    std::uint64_t slots = 2;
    while (3 * slots < 4 * voxels) slots *= 2;
    return slots;
  }

  explicit Renaming(std::uint64_t voxels) : slots_(slots_for(voxels), kFree) {}

  // The slot of a voxel, or the free one where it belongs. is_of(number): whether that number is
  // the voxel's. Counts the slots that are looked at.
  template <class IsOf>
  std::uint32_t find(std::uint32_t voxel, const IsOf& is_of, std::uint64_t& looked_at) const {
    std::uint32_t slot = first_slot(voxel);
    for (;; slot = (slot + 1) & mask()) {
      ++looked_at;
      if (slots_[slot] == kFree || is_of(slots_[slot])) return slot;
    }
  }
  bool taken(std::uint32_t slot) const { return slots_[slot] != kFree; }
  std::uint32_t number(std::uint32_t slot) const { return slots_[slot]; }
  void take(std::uint32_t slot, std::uint32_t number) {
    slots_[slot] = number;
    taken_.push_back(slot);
  }
  void clear() {
    for (const std::uint32_t slot : taken_) slots_[slot] = kFree;
    taken_.clear();
  }

 private:
  static constexpr std::uint32_t kFree = ~0U;

  std::uint32_t mask() const { return static_cast<std::uint32_t>(slots_.size() - 1); }
  // Neighbouring voxels have neighbouring ids, of which several runs would lie on top of one
  // another: three shifts and exclusive ors spread them (Marsaglia, "Xorshift RNGs", 2003).
  std::uint32_t first_slot(std::uint32_t voxel) const {
    voxel ^= voxel << 13U;
    voxel ^= voxel >> 17U;
    voxel ^= voxel << 5U;
    return voxel & mask();
  }

  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> taken_;
};

}  // namespace sgs
