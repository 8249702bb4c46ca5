// Maintenance of a rank besides requests: refresh and the low-power states.
#include "modules/dram/rank_maintenance.h"

#include <algorithm>

namespace sgs {

namespace {
std::uint64_t idle_limit(std::uint32_t cycles) { return cycles == 0 ? kNever : cycles; }
std::uint64_t all_of(std::uint32_t banks) { return ~std::uint64_t{0} >> (64 - banks); }
std::uint64_t after(std::uint64_t cycle, std::uint64_t delay) {
  return delay == kNever ? kNever : cycle + delay;
}
}  // namespace

RankMaintenance::RankMaintenance(const DramConfig& config, const Memspec& memspec,
                                 std::uint32_t rank)
    : mode_(config.refresh),
      rank_(rank),
      banks_(memspec.organisation.banks),
      names_bank_(config.refresh == RefreshMode::kPerBank &&
                  memspec.refresh_order == RefreshOrder::kAny),
      interval_(config.refresh == RefreshMode::kPerBank ? memspec.timing_cycles.refi_bank
                                                        : memspec.timing_cycles.refi),
      postpone_(interval_ * config.refreshes_postponed(memspec)),
      power_down_idle_(idle_limit(config.power_down_idle_cycles)),
      self_refresh_idle_(idle_limit(config.self_refresh_idle_cycles)),
      due_banks_(all_of(banks_)) {
  if (mode_ == RefreshMode::kOff) return;
  refresh_due_ = interval_;
  set_urgency(0);
  set_limits();
}

bool RankMaintenance::on_waiting(std::uint64_t banks, std::uint64_t cycle) {
  if (!names_bank_ || banks == waiting_banks_) return false;
  waiting_banks_ = banks;
  const std::uint32_t bank = refresh_bank_;
  const std::uint64_t urgent_from = urgent_from_;
  choose_bank();
  if (refresh_bank_ != bank) chosen_from_ = cycle;
  set_urgency(cycle);
  set_limits();
  return refresh_bank_ != bank || urgent_from_ != urgent_from;
}

void RankMaintenance::choose_bank() {
  refresh_bank_ = turn_;
  if (!names_bank_) return;
  const std::uint64_t idle = due_banks_ & ~waiting_banks_;
  const std::uint64_t banks = idle != 0 ? idle : due_banks_;
  const std::uint64_t from_turn = banks >> turn_ << turn_;
  refresh_bank_ = static_cast<std::uint32_t>(__builtin_ctzll(from_turn != 0 ? from_turn : banks));
}

void RankMaintenance::set_urgency(std::uint64_t cycle) {
  if (names_bank_) {
    const bool in_use = (waiting_banks_ >> refresh_bank_ & 1) != 0;
    urgent_from_ = refresh_due_ + (in_use ? postpone_ : 0);
    return;
  }
  // Once owed refreshes are being worked off they go back to back: that is what postponing gains.
  const bool still_owed = refresh_due_ <= cycle && urgent_from_ <= cycle;
  urgent_from_ = still_owed ? refresh_due_ : refresh_due_ + postpone_;
}

void RankMaintenance::set_limits() {
  if (state_ != State::kUp) {
    refresh_bank_limit_ = other_banks_limit_ = 0;
    return;
  }
  refresh_bank_limit_ = urgent_from_;
  other_banks_limit_ = mode_ == RefreshMode::kPerBank ? kNever : urgent_from_;
}

Candidate RankMaintenance::next(const DeviceTiming& device, std::uint64_t wanted_from,
                                std::uint64_t clock) const {
  switch (state_) {
    case State::kSelfRefresh:
      if (wanted_from == kNever) return {};
      return {std::max(wanted_from, device.earliest_exit(rank_)), Command::kSelfRefreshExit, rank_,
              0};
    case State::kPowerDown: {
      const std::uint64_t leave =
          std::min({wanted_from, refresh_due_, after(idle_since_, self_refresh_idle_)});
      if (leave == kNever) return {};
      return {std::max(leave, device.earliest_exit(rank_)), Command::kPowerDownExit, rank_, 0};
    }
    case State::kUp:
      break;
  }
  const auto in_time = [&](const Candidate& c) { return std::max(c.cycle, clock) < wanted_from; };
  Candidate best;
  if (refresh_due_ != kNever) {
    best = refresh(device, refresh_due_);
    if (!in_time(best)) best = refresh(device, urgent_from_);
  }
  const Candidate low_power = sleep(device);
  // Not while a refresh is due: it would be left again at once.
  if (in_time(low_power) && low_power.cycle < refresh_due_ && low_power.cycle < best.cycle)
    best = low_power;
  return best;
}

Candidate RankMaintenance::refresh(const DeviceTiming& device, std::uint64_t from) const {
  if (mode_ == RefreshMode::kPerBank) {
    from = std::max(from, chosen_from_);
    if (device.open_row(rank_, refresh_bank_) != kNoRow)
      return {std::max(from, device.earliest(RequestCommand::kPrecharge, rank_, refresh_bank_)),
              Command::kPrecharge, rank_, refresh_bank_};
    return {std::max(from, device.earliest_refresh_bank(rank_, refresh_bank_)),
            Command::kRefreshBank, rank_, refresh_bank_};
  }
  if (device.open_banks(rank_) > 0)
    return {std::max(from, device.earliest_precharge_all(rank_)), Command::kPrechargeAll, rank_, 0};
  return {std::max(from, device.earliest_refresh_all(rank_)), Command::kRefreshAll, rank_, 0};
}

Candidate RankMaintenance::sleep(const DeviceTiming& device) const {
  const std::uint64_t self_refresh_from = after(idle_since_, self_refresh_idle_);
  const std::uint64_t power_down_from = after(idle_since_, power_down_idle_);
  const std::uint64_t power_down =
      power_down_from == kNever ? kNever
                                : std::max(power_down_from, device.earliest_power_down(rank_));
  if (power_down < self_refresh_from) return {power_down, Command::kPowerDownEnter, rank_, 0};
  if (self_refresh_from == kNever) return {};
  if (device.open_banks(rank_) > 0)
    return {std::max(self_refresh_from, device.earliest_precharge_all(rank_)),
            Command::kPrechargeAll, rank_, 0};
  return {std::max(self_refresh_from, device.earliest_self_refresh(rank_)),
          Command::kSelfRefreshEnter, rank_, 0};
}

void RankMaintenance::on_command(Command command, std::uint64_t cycle) {
  switch (command) {
    case Command::kPowerDownEnter:
      state_ = State::kPowerDown;
      break;
    case Command::kPowerDownExit:
      state_ = State::kUp;
      break;
    case Command::kSelfRefreshEnter:
      state_ = State::kSelfRefresh;
      break;
    case Command::kSelfRefreshExit:
      state_ = State::kUp;
      // The device has refreshed itself; the standard asks for one refresh after leaving.
      if (mode_ != RefreshMode::kOff) {
        refresh_due_ = cycle;
        // It also begins its count of banks again.
        due_banks_ = all_of(banks_);
        turn_ = 0;
        choose_bank();
        set_urgency(0);
      }
      break;
    case Command::kRefreshBank:
      due_banks_ &= ~(std::uint64_t{1} << refresh_bank_);
      if (due_banks_ == 0) due_banks_ = all_of(banks_);
      turn_ = (refresh_bank_ + 1) % banks_;
      choose_bank();
      [[fallthrough]];
    case Command::kRefreshAll:
      refresh_due_ += interval_;
      set_urgency(cycle);
      break;
    case Command::kPrecharge:
    case Command::kPrechargeAll:
      break;
    default:
      idle_since_ = cycle;
      return;
  }
  set_limits();
}

}  // namespace sgs
