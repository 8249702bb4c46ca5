// The maker of groups' numbers register by register, a group behind the other: it takes one up when
// it is asked for, when nothing takes the numbers of the group before the last any more, and when
// its parts are free.
#pragma once

#include <cstdint>
#include <deque>

namespace sgs::test {

struct GroupNumbersHardware {
  std::uint32_t turn_cycles = 1, depth_cycles = 1;
};

class ClockedGroupNumbers {
 public:
  explicit ClockedGroupNumbers(const GroupNumbersHardware& hardware) : hw_(hardware) {}

  // Of one more group: by which it is told.
  std::uint32_t ask() { return asked_++; }
  bool stand(std::uint32_t group) const { return group < stood_; }
  // Ahead of what takes numbers in this cycle. has_registers(group): the set of the group two
  // before it is free.
  template <class HasRegisters>
  void step(const HasRegisters& has_registers) {
    for (std::uint32_t& left : under_way_) --left;
    if (!under_way_.empty() && under_way_.front() == 0) {
      under_way_.pop_front();
      ++stood_;
    }
    if (busy_ > 0) --busy_;
    if (busy_ > 0 || begun_ == asked_ || !has_registers(begun_)) return;
    ++begun_;
    under_way_.push_back(hw_.depth_cycles);
    busy_ = hw_.turn_cycles;
  }

 private:
  const GroupNumbersHardware hw_;
  std::uint32_t asked_ = 0, begun_ = 0, stood_ = 0;  // groups
  std::deque<std::uint32_t> under_way_;              // cycles until each stands
  std::uint32_t busy_ = 0;
};

}  // namespace sgs::test
