// Checks a stream of DRAM commands against the list of constraints.
#include "modules/dram/trace_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <numeric>

namespace sgs {

namespace {

using C = Command;

constexpr std::uint32_t set_of(std::initializer_list<Command> commands) {
  std::uint32_t set = 0;
  for (const Command c : commands) set |= 1u << static_cast<std::uint32_t>(c);
  return set;
}
constexpr bool contains(std::uint32_t set, Command c) {
  return (set >> static_cast<std::uint32_t>(c) & 1) != 0;
}

constexpr std::uint32_t kReads = set_of({C::kRead, C::kReadAuto});
constexpr std::uint32_t kWrites = set_of({C::kWrite, C::kWriteAuto});
constexpr std::uint32_t kActivations = set_of({C::kActivate, C::kRefreshBank});
constexpr std::uint32_t kNeedsClosedRank = set_of({C::kRefreshAll, C::kSelfRefreshEnter});
constexpr std::uint32_t kEverything = (1u << kCommands) - 1;
constexpr std::uint32_t kExits = set_of({C::kPowerDownExit, C::kSelfRefreshExit});
constexpr std::uint32_t kSleeps = set_of({C::kPowerDownEnter, C::kSelfRefreshEnter});

std::uint32_t write_end_of(const Memspec& m, WriteLatencySet set) {
  const Memspec::Timing& t = m.timing_cycles;
  return (set == WriteLatencySet::kA ? t.write_latency_a : t.write_latency_b) + t.dqss +
         m.organisation.burst_length / m.organisation.beats_per_clock;
}

}  // namespace

std::string TraceViolation::text() const {
  const std::string what =
      fmt::format("cycle {}: channel {} {} rank {} bank {}: {}", record.cycle, record.channel,
                  kCommandNames[static_cast<std::size_t>(record.command)], record.rank, record.bank,
                  constraint);
  return earliest == 0 ? what : fmt::format("{}, legal from cycle {}", what, earliest);
}

std::vector<TraceChecker::Rule> TraceChecker::rules(const Memspec& m, WriteLatencySet set) {
  const Memspec::Timing& t = m.timing_cycles;
  const std::uint64_t burst = m.organisation.burst_length / m.organisation.beats_per_clock;
  const std::uint64_t wl = set == WriteLatencySet::kA ? t.write_latency_a : t.write_latency_b;
  const std::uint64_t read_end = t.read_latency + t.dqsck_max + burst;
  const std::uint64_t write_end = write_end_of(m, set);
  const std::uint64_t next_read = t.read_latency + t.dqsck_min;
  const std::uint64_t write_to_other_read =
      write_end + t.rtrs > next_read ? write_end + t.rtrs - next_read : 1;
  const std::uint32_t precharges = set_of({C::kPrecharge, C::kPrechargeAll});
  const std::uint32_t activate = set_of({C::kActivate});
  const std::uint32_t refresh_bank = set_of({C::kRefreshBank});
  std::vector<Rule> rules = {
      {"tRCD", activate, kReads, Scope::kSameBank, t.rcd},
      {"tRCD", activate, kWrites, Scope::kSameBank, t.rcd_write > 0 ? t.rcd_write : t.rcd},
      {"tRAS", activate, set_of({C::kPrecharge}), Scope::kSameBank, t.ras},
      {"tRAS", activate, set_of({C::kPrechargeAll}), Scope::kSameRank, t.ras},
      {"tRC", activate, kActivations, Scope::kSameBank, t.rc},
      {"tRC", activate, kNeedsClosedRank, Scope::kSameRank, t.rc},
      {"tRPpb", set_of({C::kPrecharge}), kActivations, Scope::kSameBank, t.rp_bank},
      {"tRPpb", set_of({C::kPrecharge}), kNeedsClosedRank, Scope::kSameRank, t.rp_bank},
      {"tRPab", set_of({C::kPrechargeAll}), kActivations | kNeedsClosedRank, Scope::kSameRank,
       t.rp_all},
      {"tRRD", activate, kActivations, Scope::kSameRank, t.rrd},
      {"tRTP", kReads, set_of({C::kPrecharge}), Scope::kSameBank, t.rtp},
      {"tRTP", kReads, set_of({C::kPrechargeAll}), Scope::kSameRank, t.rtp},
      {"tWR", kWrites, set_of({C::kPrecharge}), Scope::kSameBank, write_end + t.wr},
      {"tWR", kWrites, set_of({C::kPrechargeAll}), Scope::kSameRank, write_end + t.wr},
      {"tCCD", kReads, kReads, Scope::kSameRank, t.ccd},
      {"tCCD", kWrites, kWrites, Scope::kSameRank, t.ccd},
      {"read to write", kReads, kWrites, Scope::kSameRank, t.rtw > 0 ? t.rtw : read_end + 1 - wl},
      {"tWTR", kWrites, kReads, Scope::kSameRank, write_end + t.wtr},
      {"tRTRS", kReads, kReads, Scope::kOtherRank, burst + t.rtrs},
      {"tRTRS", kWrites, kWrites, Scope::kOtherRank, burst + t.rtrs},
      {"tRTRS read to write", kReads, kWrites, Scope::kOtherRank, read_end + t.rtrs - wl},
      {"tRTRS write to read", kWrites, kReads, Scope::kOtherRank, write_to_other_read},
      {"tRFCab", set_of({C::kRefreshAll}), kActivations | kNeedsClosedRank | kSleeps,
       Scope::kSameRank, t.rfc_all},
      {"tRFCpb", refresh_bank, kActivations, Scope::kSameBank, t.rfc_bank},
      {"tRFCpb", refresh_bank, kNeedsClosedRank | kSleeps, Scope::kSameRank, t.rfc_bank},
      {"read before power-down", kReads, kSleeps, Scope::kSameRank, read_end + 1},
      {"write before power-down", kWrites, kSleeps, Scope::kSameRank, write_end + t.wr},
      {"write before power-down", set_of({C::kWriteAuto}), kSleeps, Scope::kSameRank,
       write_end + t.wr + 1},
      {"row command before power-down", activate | precharges, kSleeps, Scope::kSameRank, 1},
      {"tCKE", set_of({C::kPowerDownEnter}), set_of({C::kPowerDownExit}), Scope::kSameRank, t.cke},
      {"tCKE", set_of({C::kPowerDownExit}), kSleeps, Scope::kSameRank, t.cke},
      {"tXP", set_of({C::kPowerDownExit}), kEverything & ~kExits, Scope::kSameRank, t.xp},
      {"tCKESR", set_of({C::kSelfRefreshEnter}), set_of({C::kSelfRefreshExit}), Scope::kSameRank,
       t.cke_self_refresh},
      {"tXSR", set_of({C::kSelfRefreshExit}), kEverything & ~kExits, Scope::kSameRank, t.xsr},
  };
  // Constraints that some standards have of their own, and others share with another.
  if (t.pbr2pbr > 0)
    rules.push_back({"tpbR2pbR", refresh_bank, refresh_bank, Scope::kSameRank, t.pbr2pbr});
  else
    rules.push_back({"tRFCpb", refresh_bank, refresh_bank, Scope::kSameRank, t.rfc_bank});
  if (t.pbr2act > 0)
    rules.push_back({"tpbR2act", refresh_bank, activate, Scope::kSameRank, t.pbr2act});
  else
    rules.push_back({"tRRD", refresh_bank, activate, Scope::kSameRank, t.rrd});
  if (m.organisation.bank_groups == 1) return rules;
  const std::uint64_t writes_apart = t.ccd_l_write > 0 ? t.ccd_l_write : t.ccd_l;
  rules.push_back({"tCCD_L", kReads, kReads, Scope::kSameGroup, t.ccd_l});
  rules.push_back({"tCCD_L_WR", kWrites, kWrites, Scope::kSameGroup, writes_apart});
  rules.push_back({"tRRD_L", activate, activate, Scope::kSameGroup, t.rrd_l});
  rules.push_back({"tWTR_L", kWrites, kReads, Scope::kSameGroup, write_end + t.wtr_l});
  return rules;
}

TraceChecker::TraceChecker(const Memspec& memspec, const CommandTraceHeader& header)
    : memspec_(memspec),
      header_(header),
      write_end_(write_end_of(memspec, header.write_latency_set)),
      channels_(header.channels * memspec.organisation.pseudo_channels) {
  for (const Rule& rule : rules(memspec, header.write_latency_set))
    for (std::size_t c = 0; c < kCommands; ++c)
      if (contains(rule.after, static_cast<Command>(c))) rules_by_command_[c].push_back(rule);
  for (Channel& channel : channels_) {
    channel.ranks.resize(header.ranks);
    for (Rank& rank : channel.ranks) {
      rank.banks.resize(memspec.organisation.banks);
      rank.groups.resize(memspec.organisation.bank_groups);
    }
  }
}

void TraceChecker::Verdict::at_least(std::uint64_t cycle, const char* name) {
  if (cycle <= earliest) return;
  earliest = cycle;
  if (!forbidden) constraint = name;
}

void TraceChecker::Verdict::forbid(const std::string& name) {
  if (!forbidden) constraint = name;
  forbidden = true;
}

bool TraceChecker::in_range(const CommandRecord& r) const {
  return r.channel < channels_.size() && r.rank < header_.ranks &&
         r.bank < memspec_.organisation.banks && r.row < memspec_.organisation.rows &&
         r.burst < memspec_.bursts_per_row();
}

std::uint32_t TraceChecker::banks_of(const CommandRecord& r) const {
  if (r.command != C::kRefreshBank) return 1;
  return std::min(memspec_.organisation.banks_per_refresh, memspec_.organisation.banks - r.bank);
}

std::size_t TraceChecker::bus_of(C command) const {
  const bool column = contains(kReads | kWrites, command);
  return column ? memspec_.command_bus.buses - 1 : 0;
}

std::vector<std::uint64_t> TraceChecker::bus_cycles(C command, std::uint64_t last) const {
  const Memspec::CommandBus& bus = memspec_.command_bus;
  if (command == C::kPowerDownEnter || command == C::kPowerDownExit) return {last};
  const bool activate = command == C::kActivate;
  if (activate && bus.activate_gap > 0) return {last - bus.activate_gap - 1, last};
  const bool column = contains(kReads | kWrites, command);
  std::vector<std::uint64_t> cycles(activate ? bus.activate : column ? bus.column : bus.row);
  std::iota(cycles.begin(), cycles.end(), last + 1 - cycles.size());
  return cycles;
}

std::optional<TraceViolation> TraceChecker::check(const CommandRecord& record) {
  ++checked_;
  if (!in_range(record))
    return TraceViolation{record, "no such channel, rank, bank, row or burst", 0};
  const Channel& channel = channels_[record.channel];
  const Rank& rank = channel.ranks[record.rank];
  Verdict verdict;
  check_state(record, rank, verdict);
  check_distances(record, channel, verdict);
  check_windows(record, rank, verdict);
  apply(record);
  if (verdict.forbidden) return TraceViolation{record, verdict.constraint, 0};
  if (record.cycle < verdict.earliest)
    return TraceViolation{record, verdict.constraint, verdict.earliest};
  return std::nullopt;
}

void TraceChecker::on_command(const CommandRecord& record) {
  const std::optional<TraceViolation> violation = check(record);
  if (violation && !first_) first_ = violation;
}

void TraceChecker::check_state(const CommandRecord& r, const Rank& rank, Verdict& verdict) const {
  const std::uint32_t together = memspec_.organisation.banks_per_refresh;
  const auto bank = rank.banks.begin() + r.bank;
  const bool any_open =
      std::any_of(rank.banks.begin(), rank.banks.end(), [](const Bank& b) { return b.open; });
  const std::uint32_t self = 1u << static_cast<std::uint32_t>(r.command);
  if (r.command == C::kPowerDownExit) {
    if (!rank.powered_down) verdict.forbid("power-down exit without entry");
  } else if (r.command == C::kSelfRefreshExit) {
    if (!rank.self_refresh) verdict.forbid("self-refresh exit without entry");
  } else if (rank.powered_down || rank.self_refresh) {
    verdict.forbid("command while the clock enable is low");
  }
  if (r.command == C::kActivate && bank->open) verdict.forbid("activate of an open bank");
  if ((self & (kReads | kWrites)) != 0 && !bank->open) verdict.forbid("column of a closed bank");
  if ((self & kNeedsClosedRank) != 0 && any_open) verdict.forbid("refresh with an open bank");
  if (r.command != C::kRefreshBank) return;
  if (r.bank % together != 0) verdict.forbid("refresh of banks that do not go together");
  if (std::any_of(bank, bank + banks_of(r), [](const Bank& b) { return b.open; }))
    verdict.forbid("refresh of an open bank");
  if (memspec_.refresh_order == RefreshOrder::kAny) {
    if ((rank.had_their_turn >> r.bank & 1) != 0) verdict.forbid("refreshed again before others");
  } else if (r.bank != rank.next_bank) {
    verdict.forbid("refresh out of turn");
  }
}

void TraceChecker::check_distances(const CommandRecord& r, const Channel& channel,
                                   Verdict& verdict) const {
  const std::set<std::uint64_t>& taken = channel.bus[bus_of(r.command)];
  const auto is_taken = [&](std::uint64_t last) {
    const std::vector<std::uint64_t> cycles = bus_cycles(r.command, last);
    return std::any_of(cycles.begin(), cycles.end(),
                       [&](std::uint64_t cycle) { return taken.count(cycle) > 0; });
  };
  std::uint64_t free = std::max(r.cycle, channel.last_cycle);
  while (is_taken(free)) ++free;
  if (free > r.cycle) verdict.at_least(free, "command bus");
  const auto consider = [&](const Times& last, const Rule& rule) {
    for (std::size_t c = 0; c < kCommands; ++c)
      if (contains(rule.before, static_cast<Command>(c)) && last[c] != 0)
        verdict.at_least(last[c] - 1 + rule.cycles, rule.name);
  };
  for (const Rule& rule : rules_by_command_[static_cast<std::size_t>(r.command)]) {
    for (std::size_t rank = 0; rank < channel.ranks.size(); ++rank) {
      const bool same = rank == r.rank;
      if (same == (rule.scope == Scope::kOtherRank)) continue;
      const Rank& state = channel.ranks[rank];
      if (rule.scope == Scope::kSameBank)
        for (std::uint32_t b = r.bank; b < r.bank + banks_of(r); ++b)
          consider(state.banks[b].last, rule);
      else if (rule.scope == Scope::kSameGroup)
        consider(state.groups[r.bank % state.groups.size()], rule);
      else
        consider(state.last, rule);
    }
  }
}

void TraceChecker::check_windows(const CommandRecord& r, const Rank& rank, Verdict& verdict) const {
  const Memspec::Timing& t = memspec_.timing_cycles;
  const std::uint32_t self = 1u << static_cast<std::uint32_t>(r.command);
  if ((self & kActivations) != 0) {
    if (rank.activations.size() == 4) verdict.at_least(rank.activations.front() + t.faw, "tFAW");
    for (std::uint32_t b = r.bank; b < r.bank + banks_of(r); ++b)
      if (rank.banks[b].auto_closed != 0)
        verdict.at_least(rank.banks[b].auto_closed + t.rp_bank, "auto-precharge + tRPpb");
  }
  if ((self & kNeedsClosedRank) != 0)
    for (const Bank& bank : rank.banks)
      if (bank.auto_closed != 0)
        verdict.at_least(bank.auto_closed + t.rp_bank, "auto-precharge + tRPpb");
  // A study without refresh ignores how long cells hold their charge, open rows included.
  if (header_.refresh == RefreshMode::kOff) return;
  if (r.command == C::kSelfRefreshEnter && rank.owed_after_exit > 0)
    verdict.forbid("self-refresh again before a refresh of all banks");
  for (const Bank& bank : rank.banks)
    if (bank.open && r.cycle > bank.opened + t.ras_max) verdict.forbid("tRASmax");
  if (!rank.self_refresh) {
    const bool all = header_.refresh == RefreshMode::kAllBank;
    const std::uint64_t interval = all ? t.refi : t.refi_bank;
    const std::uint64_t owed = memspec_.refresh_postpone_limit + 1;
    const std::uint64_t most = all ? owed : owed * memspec_.refresh_sets();
    const std::uint64_t elapsed =
        r.cycle > rank.refreshes_due_from ? r.cycle - rank.refreshes_due_from : 0;
    if (elapsed / interval > rank.refreshes + most)
      verdict.forbid(fmt::format("tREFI: more than {} postponed", memspec_.refresh_postpone_limit));
  }
}

void TraceChecker::apply(const CommandRecord& r) {
  const Memspec::Timing& t = memspec_.timing_cycles;
  Channel& channel = channels_[r.channel];
  Rank& rank = channel.ranks[r.rank];
  Bank& bank = rank.banks[r.bank];
  const auto c = static_cast<std::size_t>(r.command);
  channel.last_cycle = std::max(channel.last_cycle, r.cycle);
  std::set<std::uint64_t>& taken = channel.bus[bus_of(r.command)];
  for (const std::uint64_t cycle : bus_cycles(r.command, r.cycle)) taken.insert(cycle);
  constexpr std::size_t kKept = 64;  // no command looks farther back
  while (taken.size() > kKept) taken.erase(taken.begin());
  rank.last[c] = r.cycle + 1;
  rank.groups[r.bank % rank.groups.size()][c] = r.cycle + 1;
  for (std::uint32_t b = r.bank; b < r.bank + banks_of(r); ++b) rank.banks[b].last[c] = r.cycle + 1;
  switch (r.command) {
    case C::kActivate:
      bank.open = true;
      bank.opened = r.cycle;
      bank.auto_closed = 0;
      break;
    case C::kReadAuto:
      bank.open = false;
      bank.auto_closed = std::max(r.cycle + t.rtp, bank.opened + t.ras);
      break;
    case C::kWriteAuto:
      bank.open = false;
      bank.auto_closed = std::max(r.cycle + write_end_ + t.wr, bank.opened + t.ras);
      break;
    case C::kPrecharge:
      bank.open = false;
      break;
    case C::kPrechargeAll:
      for (Bank& b : rank.banks) b.open = false;
      break;
    case C::kPowerDownEnter:
      rank.powered_down = true;
      break;
    case C::kPowerDownExit:
      rank.powered_down = false;
      break;
    case C::kSelfRefreshEnter:
      rank.self_refresh = true;
      break;
    case C::kSelfRefreshExit:
      rank.self_refresh = false;
      rank.refreshes_due_from = r.cycle;
      rank.refreshes = 0;
      rank.owed_after_exit = memspec_.refresh_sets();
      rank.next_bank = 0;
      rank.had_their_turn = 0;
      break;
    default:
      break;
  }
  if (r.command == C::kRefreshAll || r.command == C::kRefreshBank) ++rank.refreshes;
  if (r.command == C::kRefreshBank && rank.owed_after_exit > 0) --rank.owed_after_exit;
  if (r.command == C::kRefreshAll) {  // it, too, begins the count of banks again
    rank.owed_after_exit = 0;
    rank.next_bank = 0;
    rank.had_their_turn = 0;
  }
  if (r.command == C::kRefreshBank) {
    const std::size_t banks = rank.banks.size();
    const std::uint32_t together = memspec_.organisation.banks_per_refresh;
    rank.next_bank = (rank.next_bank + together) % static_cast<std::uint32_t>(banks);
    for (std::uint32_t b = r.bank; b < r.bank + banks_of(r); ++b)
      rank.had_their_turn |= std::uint64_t{1} << b;
    if (rank.had_their_turn == ~std::uint64_t{0} >> (64 - banks)) rank.had_their_turn = 0;
  }
  if (contains(kActivations, r.command)) {
    rank.activations.push_back(r.cycle);
    if (rank.activations.size() > 4) rank.activations.pop_front();
  }
}

}  // namespace sgs
