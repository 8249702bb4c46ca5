// Bursts, rows and their latencies.
#include "modules/dram/dram_estimate.h"

#include <algorithm>
#include <cmath>

namespace sgs {
namespace {

constexpr std::uint64_t kWindowCycles = 16;  // in which bursts come as if at once: of four

DramConfig validated(const DramConfig& config) {
  config.validate();
  return config;
}

}  // namespace

DramEstimate::DramEstimate(const DramConfig& config, double machine_mhz)
    : config_(validated(config)),
      memspec_(load_memspec(config.memspec)),
      mapping_(config_, memspec_),
      path_(config_, memspec_),
      derived_(memspec_, config.write_latency_set, config.read_strobe),
      dram_cycles_(1e3 / machine_mhz / memspec_.clock_period_ns),
      buses_(config.channels, BookedTime(kWindowCycles)),
      banks_(std::size_t{config.channels} * config.ranks * memspec_.organisation.banks),
      counts_(DramStats::of(memspec_, config.channels)) {
  counts_.ranks.resize(std::size_t{config.channels} * config.ranks);
}

std::uint64_t DramEstimate::dram_cycle(std::uint64_t cycle) const {
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(cycle) * dram_cycles_));
}

std::uint64_t DramEstimate::refresh_cycles() const {
  const Memspec::Timing& t = memspec_.timing_cycles;
  if (config_.refresh == RefreshMode::kOff) return 0;
  return config_.refresh == RefreshMode::kAllBank
             ? t.refi
             : std::uint64_t{t.refi_bank} * memspec_.organisation.banks;
}

// A refresh closes the bank.
RowOutcome DramEstimate::find_row(const DramAddress& place, std::uint64_t now) {
  Bank& bank = bank_of(place);
  const std::uint64_t between = refresh_cycles();
  const std::uint64_t refreshes = between == 0 ? 0 : now / between;
  if (refreshes > bank.refreshes) {
    bank.open_row = kNoRow;
    bank.refreshes = refreshes;
  }
  const RowOutcome outcome = bank.open_row == place.row ? RowOutcome::kHit
                             : bank.open_row == kNoRow  ? RowOutcome::kMiss
                                                        : RowOutcome::kConflict;
  bank.open_row = config_.page_policy == PagePolicyKind::kClosed ? kNoRow : place.row;
  return outcome;
}

// The cycle of the first column command for a request that is there in `now`: behind the activate
// that the row wants, which its bank can take tRC after the one before.
std::uint64_t DramEstimate::column_from(const DramAddress& place, RowOutcome outcome,
                                        std::uint64_t now) {
  if (outcome == RowOutcome::kHit) return now;
  const Memspec::Timing& t = memspec_.timing_cycles;
  Bank& bank = bank_of(place);
  std::uint64_t activate = now + (outcome == RowOutcome::kConflict ? t.rp_bank : 0);
  // What was asked for before may be of a later time.
  if (bank.activated <= activate) activate = std::max(activate, bank.activated + t.rc);
  bank.activated = std::max(bank.activated, activate);
  return activate + t.rcd;
}

std::uint64_t DramEstimate::answered(std::uint64_t cycle, const Transaction& of) {
  const bool writes = of.direction == Direction::kWrite;
  const std::uint64_t comes = dram_cycle(cycle), run = mapping_.run_bytes();
  const std::uint64_t end = of.address + of.bytes, burst_bytes = mapping_.burst_bytes();
  counts_.traffic.add(of.requester, of.region, of.direction, of.bytes);
  std::uint64_t done = comes;
  for (std::uint64_t at = of.address & ~(burst_bytes - 1); at < end;) {
    const std::uint64_t stop = std::min(end, (at & ~(run - 1)) + run);
    const std::uint64_t bursts = (stop - at + burst_bytes - 1) / burst_bytes;
    const DramAddress place = mapping_.decode(at);
    const RowOutcome outcome = find_row(place, comes);
    const std::uint64_t data = column_from(place, outcome, comes + path_.front_end) +
                               (writes ? derived_.write_data_end : derived_.read_data_end) -
                               derived_.burst;
    done = std::max(done, buses_[place.channel].book(data, bursts * derived_.burst));

    DramChannelStats& channel = counts_.channels[place.channel];
    channel.rows.count(outcome);
    channel.rows.bursts[static_cast<std::size_t>(RowOutcome::kHit)] += bursts - 1;
    channel.commands[static_cast<std::size_t>(writes ? Command::kWrite : Command::kRead)] += bursts;
    counts_.bursts_by_region[of.region][writes ? 1 : 0] += bursts;
    const std::uint64_t activates = outcome == RowOutcome::kHit ? 0 : 1;
    channel.commands[static_cast<std::size_t>(Command::kActivate)] += activates;
    RankActivity& rank = counts_.ranks[rank_of(place)];
    (writes ? rank.writes : rank.reads) += bursts;
    rank.activates += activates;
    (writes ? regions_[of.region].writes : regions_[of.region].reads) += bursts;
    regions_[of.region].activates += activates;
    at = stop;
  }
  if (writes && config_.posted_writes) return cycle;
  done += path_.back_end(of.direction);
  if (!writes) counts_.read_latency_cycles.add(done - comes);
  const double answer = static_cast<double>(done) / dram_cycles_;
  return std::max(cycle, static_cast<std::uint64_t>(std::ceil(answer)));
}

std::uint64_t DramEstimate::least_cycles() const {
  std::uint64_t busiest = 0;
  for (const BookedTime& bus : buses_) busiest = std::max(busiest, bus.busy_cycles());
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(busiest) / dram_cycles_));
}

// With open pages some bank is open all the time.
DramStats DramEstimate::stats(std::uint64_t cycle) const {
  const Memspec::Timing& t = memspec_.timing_cycles;
  DramStats stats = counts_;
  stats.elapsed_cycles = stats.busy_cycles = dram_cycle(cycle);
  for (std::size_t c = 0; c < buses_.size(); ++c) {
    stats.channels[c].busy_cycles = buses_[c].busy_cycles();
  }
  const bool all = config_.refresh == RefreshMode::kAllBank;
  const std::uint64_t between = all ? t.refi : t.refi_bank;
  for (std::size_t r = 0; r < stats.ranks.size(); ++r) {
    RankActivity& rank = stats.ranks[r];
    const std::uint64_t refreshes =
        config_.refresh == RefreshMode::kOff ? 0 : stats.elapsed_cycles / between;
    (all ? rank.refreshes_all : rank.refreshes_bank) = refreshes;
    stats.channels[r / config_.ranks]
        .commands[static_cast<std::size_t>(all ? Command::kRefreshAll : Command::kRefreshBank)] +=
        refreshes;
    const bool closed = config_.page_policy == PagePolicyKind::kClosed;
    rank.active_cycles =
        closed ? std::min(stats.elapsed_cycles, rank.activates * t.ras) : stats.elapsed_cycles;
    rank.precharged_cycles = stats.elapsed_cycles - rank.active_cycles;
  }
  add_energy(stats, memspec_, config_, regions_);
  return stats;
}

}  // namespace sgs
