// What a rank owes in refreshes, cycle by cycle: a counter that goes up every tREFI and down with
// each refresh. Without requests one goes as soon as it is owed. Beside requests as many may be
// owed as are allowed; one more, and refreshes go first until none is owed.
//
// Where the controller names the bank, it is looked for every cycle: of those that have not had
// their turn in this round the next one, round the banks, that no request waits for. Its refresh
// goes at once. If requests wait for all of them, as many may be owed as are allowed; one more, and
// the next bank's goes first. Of banks that are refreshed together this is said of the set.
#pragma once

#include <cstdint>
#include <set>

#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"

namespace sgs::test {

struct RefreshHardware {
  RefreshMode mode = RefreshMode::kOff;
  std::uint32_t most_postponed = 0;
  bool any_bank = false;  // the controller names the bank
};

class ClockedRefresh {
 public:
  ClockedRefresh(const RefreshHardware& hardware, const Memspec& memspec)
      : hw_(hardware),
        interval_(hardware.mode == RefreshMode::kPerBank ? memspec.timing_cycles.refi_bank
                                                         : memspec.timing_cycles.refi),
        together_(memspec.organisation.banks_per_refresh),
        sets_(memspec.organisation.banks / together_),
        left_(interval_) {}

  bool all_banks() const { return hw_.mode == RefreshMode::kAllBank; }
  std::uint32_t first_bank() const { return set_ * together_; }  // of those whose turn it is
  std::uint32_t end_bank() const { return (set_ + 1) * together_; }
  bool wanted(bool requests_wait) const {
    if (!requests_wait) return owed_ > 0;
    return hw_.any_bank ? owed_ > allowed() : first_;
  }
  // Nothing is begun for requests of the bank; or will not be, so many cycles from now.
  bool holds(std::uint32_t bank) const {
    return (hw_.any_bank ? owed_ > allowed() : first_) && (all_banks() || bank / together_ == set_);
  }
  bool will_hold(std::uint32_t bank, std::uint32_t cycles) const {
    const bool last_one = owed_ == allowed() && left_ <= cycles;
    return hw_.mode != RefreshMode::kOff && last_one && (all_banks() || bank / together_ == set_);
  }

  void begin_cycle(std::uint64_t now) {
    if (hw_.mode == RefreshMode::kOff || now == 0 || --left_ > 0) return;
    left_ = interval_;
    ++owed_;
    first_ = first_ || owed_ > hw_.most_postponed;
  }
  // Banks that requests wait for, at the beginning of the cycle.
  void look_for_bank(const std::set<std::uint32_t>& waiting) {
    if (!hw_.any_bank) return;
    for (const bool idle : {true, false}) {
      for (std::uint32_t i = 0; i < sets_; ++i) {
        const std::uint32_t set = (after_last_ + i) % sets_;
        in_use_ = false;
        for (const std::uint32_t bank : waiting) in_use_ = in_use_ || bank / together_ == set;
        if (had_turn_.count(set) > 0 || (idle && in_use_)) continue;
        set_ = set;
        return;
      }
    }
  }
  void refreshed() {
    if (--owed_ == 0) first_ = false;
    had_turn_.insert(set_);
    if (had_turn_.size() == sets_) had_turn_.clear();
    set_ = after_last_ = (set_ + 1) % sets_;
  }

 private:
  std::uint32_t allowed() const { return !hw_.any_bank || in_use_ ? hw_.most_postponed : 0; }

  const RefreshHardware hw_;
  const std::uint32_t interval_, together_, sets_;
  std::uint32_t left_;  // cycles until another is owed
  std::uint32_t owed_ = 0, set_ = 0, after_last_ = 0;
  bool first_ = false;  // refreshes go before requests
  std::set<std::uint32_t> had_turn_;
  bool in_use_ = false;  // requests wait for a bank of set_, which the controller named
};

}  // namespace sgs::test
