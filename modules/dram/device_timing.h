// The state of one channel's devices and, for each command, the earliest cycle at which it may
// come next: a table per bank, rank and channel, brought up to date by every command.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"
#include "tlm/traffic_counters.h"

namespace sgs {

// Sums of a memspec's constants that the constraints are made of, in cycles.
struct DerivedTiming {
  DerivedTiming(const Memspec& memspec, WriteLatencySet set, ReadStrobe strobe);

  std::uint32_t burst;                     // on the data bus; BL/2 here and below
  std::uint32_t write_latency;             // WL of the chosen set
  std::uint32_t read_data_end;             // RL + tDQSCK + BL/2: command to last datum
  std::uint32_t write_data_end;            // WL + tDQSS + BL/2
  std::uint32_t read_to_write;             // tRTW, or RL + tDQSCKmax + BL/2 + 1 - WL
  std::uint32_t write_to_read;             // WL + tDQSS + BL/2 + tWTR
  std::uint32_t write_to_read_group;       // likewise of a bank group
  std::uint32_t write_to_write_group;      // tCCD_L_WR, or tCCD_L
  std::uint32_t write_to_precharge;        // WL + tDQSS + BL/2 + tWR
  std::uint32_t activate_to_read;          // tRCD
  std::uint32_t activate_to_write;         // likewise of writes
  std::uint32_t refresh_to_refresh;        // tpbR2pbR, or tRFCpb
  std::uint32_t refresh_to_activate;       // tpbR2act, or tRRD
  std::uint32_t read_to_read_other_rank;   // BL/2 + tRTRS
  std::uint32_t read_to_write_other_rank;  // RL + tDQSCKmax + BL/2 + tRTRS - WL
  std::uint32_t write_to_read_other_rank;  // write_data_end + tRTRS - RL - tDQSCKmin, at least 1
  std::uint32_t read_to_power_down;        // RL + tDQSCKmax + BL/2 + 1

  std::uint32_t activate_to_column(Direction direction) const {
    return direction == Direction::kRead ? activate_to_read : activate_to_write;
  }
};

enum class RequestCommand : std::uint8_t { kActivate, kRead, kWrite, kPrecharge };

class DeviceTiming {
 public:
  DeviceTiming(const Memspec& memspec, const DerivedTiming& derived, std::uint32_t ranks);

  const DerivedTiming& derived() const { return d_; }
  std::uint32_t banks() const { return banks_; }
  std::uint32_t ranks() const { return static_cast<std::uint32_t>(ranks_.size()); }
  std::uint32_t open_row(std::uint32_t rank, std::uint32_t bank) const {
    return bank_of(rank, bank).open_row;
  }
  std::uint32_t open_banks(std::uint32_t rank) const { return ranks_[rank].open_banks; }

  // Earliest cycle of one of the four commands that requests need; `rank` and `bank` as everywhere.
  std::uint64_t earliest(RequestCommand command, std::uint32_t rank, std::uint32_t bank) const {
    const auto c = static_cast<std::size_t>(command);
    return std::max(bank_of(rank, bank).earliest[c], ranks_[rank].earliest[c]);
  }
  // As earliest(), for a bank counted over all ranks.
  std::uint64_t earliest_flat(RequestCommand command, std::uint32_t rank,
                              std::uint32_t flat_bank) const {
    const auto c = static_cast<std::size_t>(command);
    return std::max(bank_[flat_bank].earliest[c], ranks_[rank].earliest[c]);
  }
  std::uint64_t earliest_precharge_all(std::uint32_t rank) const;
  // All banks must be closed.
  std::uint64_t earliest_refresh_all(std::uint32_t rank) const;
  // The bank must be closed, and those that are refreshed with it.
  std::uint64_t earliest_refresh_bank(std::uint32_t rank, std::uint32_t bank) const {
    return std::max(earliest(RequestCommand::kActivate, rank, bank), ranks_[rank].refresh);
  }
  std::uint64_t earliest_power_down(std::uint32_t rank) const { return ranks_[rank].power_down; }
  // All banks must be closed.
  std::uint64_t earliest_self_refresh(std::uint32_t rank) const {
    return std::max(earliest_refresh_all(rank), earliest_power_down(rank));
  }
  // Earliest cycle to leave the power state that the rank is in.
  std::uint64_t earliest_exit(std::uint32_t rank) const { return ranks_[rank].exit; }

  // Applies a command, auto-precharge included, at its cycle.
  void issue(const CommandRecord& record);

  // Each takes the command at `cycle`, which must not be before its earliest.
  void activate(std::uint32_t rank, std::uint32_t bank, std::uint32_t row, std::uint64_t cycle);
  void read(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle);
  void write(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle);
  // A read's or write's auto-precharge, directly after it.
  void close_after_column(std::uint32_t rank, std::uint32_t bank);
  void precharge(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle);
  void precharge_all(std::uint32_t rank, std::uint64_t cycle);
  void refresh_all(std::uint32_t rank, std::uint64_t cycle);
  void refresh_bank(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle);
  void enter_power_down(std::uint32_t rank, std::uint64_t cycle);
  void exit_power_down(std::uint32_t rank, std::uint64_t cycle);
  void enter_self_refresh(std::uint32_t rank, std::uint64_t cycle);
  void exit_self_refresh(std::uint32_t rank, std::uint64_t cycle);

 private:
  // Earliest cycles. A bank holds what depends on its own history, a rank the rest: tRRD and tFAW,
  // the turn-arounds, other ranks' use of the shared data bus, waking up.
  using Earliest = std::array<std::uint64_t, 4>;  // by RequestCommand
  struct Bank {
    std::uint32_t open_row = kNoRow;
    Earliest earliest{};
  };
  struct Rank {
    std::uint32_t open_banks = 0;
    Earliest earliest{};
    std::uint64_t refresh = 0;
    std::uint64_t power_down = 0;
    std::uint64_t exit = 0;
    std::array<std::uint64_t, 4> faw{};  // when each of the last four activates leaves the window
    std::uint32_t faw_next = 0;          // the oldest of them
  };

  Bank& bank_of(std::uint32_t rank, std::uint32_t bank) { return bank_[rank * banks_ + bank]; }
  const Bank& bank_of(std::uint32_t rank, std::uint32_t bank) const {
    return bank_[rank * banks_ + bank];
  }
  void count_activation(Rank& rank, std::uint64_t cycle, std::uint32_t to_next);
  // Banks of the group of `bank` may not have the command before `ready`.
  void delay_group(RequestCommand command, std::uint32_t rank, std::uint32_t bank,
                   std::uint64_t ready);
  void wake(Rank& rank, std::uint64_t ready);
  static void raise(std::uint64_t& to, std::uint64_t at_least) { to = std::max(to, at_least); }

  const Memspec::Timing t_;
  const DerivedTiming d_;
  const std::uint32_t banks_;
  const std::uint32_t groups_;
  const std::uint32_t banks_per_refresh_;
  std::vector<Bank> bank_;
  std::vector<Rank> ranks_;
};

}  // namespace sgs
