// What a rank owes in refreshes, cycle by cycle: a counter that goes up every tREFI and down with
// each refresh. Without requests one goes as soon as it is owed. Beside requests as many may be
// owed as are allowed; one more, and refreshes go first until none is owed.
#pragma once

#include <cstdint>

#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"

namespace sgs::test {

struct RefreshHardware {
  RefreshMode mode = RefreshMode::kOff;
  std::uint32_t most_postponed = 0;
};

class ClockedRefresh {
 public:
  ClockedRefresh(const RefreshHardware& hardware, const Memspec& memspec)
      : hw_(hardware),
        interval_(hardware.mode == RefreshMode::kPerBank ? memspec.timing_cycles.refi_bank
                                                         : memspec.timing_cycles.refi),
        banks_(memspec.organisation.banks),
        left_(interval_) {}

  bool all_banks() const { return hw_.mode == RefreshMode::kAllBank; }
  std::uint32_t bank() const { return bank_; }  // whose turn it is
  bool wanted(bool requests_wait) const { return requests_wait ? first_ : owed_ > 0; }
  // Nothing is begun for requests of the bank; or will not be, so many cycles from now.
  bool holds(std::uint32_t bank) const { return first_ && (all_banks() || bank == bank_); }
  bool will_hold(std::uint32_t bank, std::uint32_t cycles) const {
    const bool last_one = owed_ == hw_.most_postponed && left_ <= cycles;
    return hw_.mode != RefreshMode::kOff && last_one && (all_banks() || bank == bank_);
  }

  void begin_cycle(std::uint64_t now) {
    if (hw_.mode == RefreshMode::kOff || now == 0 || --left_ > 0) return;
    left_ = interval_;
    ++owed_;
    first_ = first_ || owed_ > hw_.most_postponed;
  }
  void refreshed() {
    if (--owed_ == 0) first_ = false;
    bank_ = (bank_ + 1) % banks_;
  }

 private:
  const RefreshHardware hw_;
  const std::uint32_t interval_, banks_;
  std::uint32_t left_;  // cycles until another is owed
  std::uint32_t owed_ = 0, bank_ = 0;
  bool first_ = false;  // refreshes go before requests
};

}  // namespace sgs::test
