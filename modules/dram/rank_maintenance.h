// Maintenance of a rank besides requests: refresh, and the low-power states while it is idle.
#pragma once

#include <cstdint>
#include <limits>

#include "modules/dram/command.h"
#include "modules/dram/device_timing.h"
#include "modules/dram/dram_config.h"

namespace sgs {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

// A command that may be sent, and the earliest cycle for it.
struct Candidate {
  std::uint64_t cycle = kNever;
  Command command = Command::kActivate;
  std::uint32_t rank = 0;
  std::uint32_t bank = 0;
};

class RankMaintenance {
 public:
  RankMaintenance(const DramConfig& config, const Memspec& memspec, std::uint32_t rank);

  // Requests that are through the front end wait for these banks of the rank, a bit each, from
  // `cycle` on. A refresh whose bank the controller names goes to one that nobody waits for. True
  // if that changes next() or request_limit().
  bool on_waiting(std::uint64_t banks, std::uint64_t cycle);

  // The next command that the rank wants for itself, not before `clock`. `wanted_from`: the cycle
  // from which requests wait for this rank, kNever when none does.
  Candidate next(const DeviceTiming& device, std::uint64_t wanted_from, std::uint64_t clock) const;

  // That waking from self-refresh asks for, where any is left.
  Candidate owed_refresh(const DeviceTiming& device, std::uint64_t clock) const;

  // True if next() could come up with a command from `clock` up to `cycle`; cheap.
  bool may_act_by(std::uint64_t cycle, std::uint64_t wanted_from, std::uint64_t clock) const {
    return wanted_from > clock || state_ != State::kUp || urgent_from_ <= cycle;
  }

  // A request's command to `bank` must be sent before this cycle: refresh goes first from there.
  // 0 in a low-power state.
  std::uint64_t request_limit(std::uint32_t bank) const {
    return bank >> set_bits_ == refresh_set_ ? refresh_set_limit_ : other_banks_limit_;
  }

  bool powered_up() const { return state_ == State::kUp; }
  std::uint64_t refresh_due() const { return refresh_due_; }

  // From `cycle` on, until it is told otherwise, idle times are those between frames, or those
  // within a frame.
  void rest(bool rests, std::uint64_t cycle);

  // Every command of the rank is told to it, requests' included.
  void on_command(Command command, std::uint64_t cycle);

 private:
  enum class State { kUp, kPowerDown, kSelfRefresh };
  // Cycles without a request before either state; kNever: not entered.
  struct IdleTimes {
    explicit IdleTimes(const DramConfig& config);
    std::uint64_t power_down, self_refresh;
  };

  Candidate refresh(const DeviceTiming& device, std::uint64_t from) const;
  Candidate refresh_of_set(const DeviceTiming& device, std::uint64_t from) const;
  Candidate sleep(const DeviceTiming& device) const;
  std::uint64_t power_down_from() const;
  std::uint64_t self_refresh_from() const;
  std::uint64_t sets_of(std::uint64_t banks) const;
  void choose_set();
  void set_urgency(std::uint64_t cycle);
  void set_limits();

  const RefreshMode mode_;
  const std::uint32_t rank_;
  const std::uint32_t banks_per_refresh_;
  const std::uint32_t set_bits_;  // its logarithm
  const std::uint32_t sets_;  // of banks that a per-bank refresh takes together; most have one bank
  const bool names_bank_;
  const std::uint64_t interval_;
  const std::uint64_t postpone_;  // cycles
  const IdleTimes within_frame_, between_frames_;

  State state_ = State::kUp;
  std::uint64_t refresh_due_ = kNever;
  std::uint32_t owed_after_exit_ = 0;  // refreshes due at once, before the next self-refresh
  std::uint32_t owed_intervals_ = 1;   // that the refresh under way, or the last of these, covers
  std::uint64_t urgent_from_ = kNever;
  std::uint32_t turn_ = 0;         // the set after the last one refreshed
  std::uint32_t refresh_set_ = 0;  // whose turn it is, with per-bank refresh
  std::uint64_t chosen_from_ = 0;  // the cycle from which it has been known to be that one
  std::uint64_t due_sets_ = 0;     // a bit each: those that have not had their turn
  std::uint64_t waiting_sets_ = 0;
  std::uint64_t refresh_set_limit_ = kNever;
  std::uint64_t other_banks_limit_ = kNever;
  std::uint64_t idle_since_ = 0;
  bool rests_ = false;
  std::uint64_t rests_since_ = 0;
};

}  // namespace sgs
