// Maintenance of a rank besides requests: refresh and the low-power states.
#include "modules/dram/rank_maintenance.h"

#include <algorithm>

namespace sgs {

namespace {
std::uint64_t idle_limit(std::uint32_t cycles) { return cycles == 0 ? kNever : cycles; }
std::uint64_t all_of(std::uint32_t sets) { return ~std::uint64_t{0} >> (64 - sets); }
std::uint64_t after(std::uint64_t cycle, std::uint64_t delay) {
  return delay == kNever ? kNever : cycle + delay;
}
}  // namespace

RankMaintenance::IdleTimes::IdleTimes(const DramConfig& config)
    : power_down(idle_limit(config.power_down_idle_cycles)),
      self_refresh(idle_limit(config.self_refresh_idle_cycles)) {}

RankMaintenance::RankMaintenance(const DramConfig& config, const Memspec& memspec,
                                 std::uint32_t rank)
    : mode_(config.refresh),
      rank_(rank),
      banks_per_refresh_(memspec.organisation.banks_per_refresh),
      set_bits_(static_cast<std::uint32_t>(__builtin_ctz(banks_per_refresh_))),
      sets_(memspec.refresh_sets()),
      names_bank_(config.refresh == RefreshMode::kPerBank &&
                  memspec.refresh_order == RefreshOrder::kAny),
      interval_(config.refresh == RefreshMode::kPerBank ? memspec.timing_cycles.refi_bank
                                                        : memspec.timing_cycles.refi),
      postpone_(interval_ * config.refreshes_postponed(memspec)),
      within_frame_(config),
      between_frames_(config.at_rest()),
      due_sets_(all_of(sets_)) {
  if (mode_ == RefreshMode::kOff) return;
  refresh_due_ = interval_;
  set_urgency(0);
  set_limits();
}

std::uint64_t RankMaintenance::sets_of(std::uint64_t banks) const {
  if (banks_per_refresh_ == 1) return banks;
  std::uint64_t sets = 0;
  for (; banks != 0; banks &= banks - 1)
    sets |= std::uint64_t{1} << (__builtin_ctzll(banks) >> set_bits_);
  return sets;
}

bool RankMaintenance::on_waiting(std::uint64_t banks, std::uint64_t cycle) {
  if (!names_bank_) return false;
  const std::uint64_t sets = sets_of(banks);
  if (sets == waiting_sets_) return false;
  waiting_sets_ = sets;
  const std::uint32_t set = refresh_set_;
  const std::uint64_t urgent_from = urgent_from_;
  choose_set();
  if (refresh_set_ != set) chosen_from_ = cycle;
  set_urgency(cycle);
  set_limits();
  return refresh_set_ != set || urgent_from_ != urgent_from;
}

void RankMaintenance::choose_set() {
  refresh_set_ = turn_;
  if (!names_bank_) return;
  const std::uint64_t idle = due_sets_ & ~waiting_sets_;
  const std::uint64_t sets = idle != 0 ? idle : due_sets_;
  const std::uint64_t from_turn = sets >> turn_ << turn_;
  refresh_set_ = static_cast<std::uint32_t>(__builtin_ctzll(from_turn != 0 ? from_turn : sets));
}

void RankMaintenance::set_urgency(std::uint64_t cycle) {
  if (owed_after_exit_ > 0) {  // requests may go first until the next interval is over
    urgent_from_ = refresh_due_ + interval_ * owed_intervals_ + postpone_;
    return;
  }
  if (names_bank_) {
    const bool in_use = (waiting_sets_ >> refresh_set_ & 1) != 0;
    urgent_from_ = refresh_due_ + (in_use ? postpone_ : 0);
    return;
  }
  // Once owed refreshes are being worked off they go back to back: that is what postponing gains.
  const bool still_owed = refresh_due_ <= cycle && urgent_from_ <= cycle;
  urgent_from_ = still_owed ? refresh_due_ : refresh_due_ + postpone_;
}

void RankMaintenance::set_limits() {
  if (state_ != State::kUp) {
    refresh_set_limit_ = other_banks_limit_ = 0;
    return;
  }
  refresh_set_limit_ = urgent_from_;
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
      const std::uint64_t leave = std::min({wanted_from, refresh_due_, self_refresh_from()});
      if (leave == kNever) return {};
      return {std::max(leave, device.earliest_exit(rank_)), Command::kPowerDownExit, rank_, 0};
    }
    case State::kUp:
      break;
  }
  const auto in_time = [&](const Candidate& c) { return std::max(c.cycle, clock) < wanted_from; };
  Candidate best;
  if (refresh_due_ != kNever) {
    best = refresh(device, std::max(refresh_due_, clock));
    if (!in_time(best)) best = refresh(device, std::max(urgent_from_, clock));
  }
  const Candidate low_power = sleep(device);
  // Not while a refresh is due: it would be left again at once.
  if (in_time(low_power) && low_power.cycle < refresh_due_ && low_power.cycle < best.cycle)
    best = low_power;
  return best;
}

Candidate RankMaintenance::owed_refresh(const DeviceTiming& device, std::uint64_t clock) const {
  return owed_after_exit_ > 0 ? refresh(device, std::max(refresh_due_, clock)) : Candidate{};
}

Candidate RankMaintenance::refresh(const DeviceTiming& device, std::uint64_t from) const {
  if (mode_ == RefreshMode::kPerBank) return refresh_of_set(device, std::max(from, chosen_from_));
  if (device.open_banks(rank_) > 0)
    return {std::max(from, device.earliest_precharge_all(rank_)), Command::kPrechargeAll, rank_, 0};
  return {std::max(from, device.earliest_refresh_all(rank_)), Command::kRefreshAll, rank_, 0};
}

Candidate RankMaintenance::refresh_of_set(const DeviceTiming& device, std::uint64_t from) const {
  const std::uint32_t first = refresh_set_ * banks_per_refresh_;
  Candidate precharge, refresh{from, Command::kRefreshBank, rank_, first};
  for (std::uint32_t bank = first; bank < first + banks_per_refresh_; ++bank) {
    refresh.cycle = std::max(refresh.cycle, device.earliest_refresh_bank(rank_, bank));
    if (device.open_row(rank_, bank) == kNoRow) continue;
    const std::uint64_t closes =
        std::max(from, device.earliest(RequestCommand::kPrecharge, rank_, bank));
    if (closes < precharge.cycle) precharge = {closes, Command::kPrecharge, rank_, bank};
  }
  return precharge.cycle == kNever ? refresh : precharge;
}

Candidate RankMaintenance::sleep(const DeviceTiming& device) const {
  const std::uint64_t self_refresh_from = this->self_refresh_from();
  const std::uint64_t power_down_from = this->power_down_from();
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

std::uint64_t RankMaintenance::power_down_from() const {
  return after(std::max(idle_since_, rests_since_),
               (rests_ ? between_frames_ : within_frame_).power_down);
}

std::uint64_t RankMaintenance::self_refresh_from() const {
  return after(std::max(idle_since_, rests_since_),
               (rests_ ? between_frames_ : within_frame_).self_refresh);
}

void RankMaintenance::rest(bool rests, std::uint64_t cycle) {
  rests_ = rests;
  rests_since_ = rests ? cycle : 0;
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
      // The device has refreshed itself. JESD209-3 asks for a refresh of all banks after leaving
      // and before entering again, all at once or bank by bank.
      if (mode_ != RefreshMode::kOff) {
        refresh_due_ = cycle;
        owed_after_exit_ = mode_ == RefreshMode::kPerBank ? sets_ : 1;
        owed_intervals_ = owed_after_exit_;
        // It also begins its count of banks again.
        due_sets_ = all_of(sets_);
        turn_ = 0;
        choose_set();
        set_urgency(cycle);
      }
      break;
    case Command::kRefreshBank:
      due_sets_ &= ~(std::uint64_t{1} << refresh_set_);
      if (due_sets_ == 0) due_sets_ = all_of(sets_);
      turn_ = (refresh_set_ + 1) % sets_;
      choose_set();
      [[fallthrough]];
    case Command::kRefreshAll:
      if (owed_after_exit_ > 0) --owed_after_exit_;
      if (owed_after_exit_ == 0) {
        refresh_due_ += interval_ * owed_intervals_;
        owed_intervals_ = 1;
      }
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
