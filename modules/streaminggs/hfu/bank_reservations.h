// Cycles to come in which each bank of a memory is taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

class BankReservations {
 public:
  // Takes the bank (below 64) in `cycle` or in the first later one in which it is free; returns
  // which.
  std::uint64_t take(std::uint32_t bank, std::uint64_t cycle) {
    const std::uint64_t bit = std::uint64_t{1} << bank;
    while (true) {
      Slot& slot = slots_[cycle % kWindowCycles];
      if (slot.cycle != cycle + 1) slot = {cycle + 1, 0};
      if ((slot.taken & bit) == 0) {
        slot.taken |= bit;
        return cycle;
      }
      ++cycle;
    }
  }

 private:
  struct Slot {
    std::uint64_t cycle = 0;  // cycle that `taken` is for, plus 1
    std::uint64_t taken = 0;  // a bit for each bank
  };
  static constexpr std::size_t kWindowCycles = 1U << 14;  // no reader looks so far ahead
  std::vector<Slot> slots_ = std::vector<Slot>(kWindowCycles);
};

}  // namespace sgs
