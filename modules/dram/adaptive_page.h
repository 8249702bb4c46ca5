// Open or closed, whichever the bank's recent past calls for: a two-bit counter a bank.
#pragma once

#include <algorithm>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/page_policy.h"

namespace sgs {

// A hit, or an activate of the row that was closed last, says that open is right; an activate that
// had to close another row first says that closed is.
class AdaptivePage : public PagePolicy {
 public:
  explicit AdaptivePage(std::uint32_t banks) : banks_(banks) {}

  bool close_after(std::uint32_t bank, bool more_hits) const override {
    return !more_hits && banks_[bank].keep_open < kThreshold;
  }

  void on_hit(std::uint32_t bank) override { raise(banks_[bank]); }

  void on_activate(std::uint32_t bank, std::uint32_t row, bool conflict) override {
    Bank& b = banks_[bank];
    if (conflict)
      b.keep_open = std::max(b.keep_open - 1, 0);
    else if (row == b.last_row)
      raise(b);
    b.last_row = row;
  }

 private:
  static constexpr int kMost = 3;
  static constexpr int kThreshold = 2;
  struct Bank {
    std::uint32_t last_row = kNoRow;
    int keep_open = kMost;
  };
  static void raise(Bank& b) { b.keep_open = std::min(b.keep_open + 1, kMost); }

  std::vector<Bank> banks_;
};

}  // namespace sgs
