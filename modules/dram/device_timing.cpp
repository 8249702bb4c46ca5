// Earliest next commands: what each command does to the tables.
#include "modules/dram/device_timing.h"

namespace sgs {

namespace {
constexpr auto kAct = static_cast<std::size_t>(RequestCommand::kActivate);
constexpr auto kRd = static_cast<std::size_t>(RequestCommand::kRead);
constexpr auto kWr = static_cast<std::size_t>(RequestCommand::kWrite);
constexpr auto kPre = static_cast<std::size_t>(RequestCommand::kPrecharge);
}  // namespace

DerivedTiming::DerivedTiming(const Memspec& memspec, WriteLatencySet set, ReadStrobe strobe) {
  const Memspec::Timing& t = memspec.timing_cycles;
  burst = memspec.burst_cycles();
  write_latency = set == WriteLatencySet::kA ? t.write_latency_a : t.write_latency_b;
  const std::uint32_t strobe_delay = strobe == ReadStrobe::kMin ? t.dqsck_min : t.dqsck_max;
  const std::uint32_t latest_read_end = t.read_latency + t.dqsck_max + burst;
  read_data_end = t.read_latency + strobe_delay + burst;
  write_data_end = write_latency + t.dqss + burst;
  read_to_write = t.rtw > 0 ? t.rtw : latest_read_end + 1 - write_latency;
  write_to_read = write_data_end + t.wtr;
  write_to_read_group = write_data_end + t.wtr_l;
  write_to_write_group = t.ccd_l_write > 0 ? t.ccd_l_write : t.ccd_l;
  activate_to_read = t.rcd;
  activate_to_write = t.rcd_write > 0 ? t.rcd_write : t.rcd;
  refresh_to_refresh = t.pbr2pbr > 0 ? t.pbr2pbr : t.rfc_bank;
  refresh_to_activate = t.pbr2act > 0 ? t.pbr2act : t.rrd;
  write_to_precharge = write_data_end + t.wr;
  read_to_read_other_rank = burst + t.rtrs;
  read_to_write_other_rank = latest_read_end + t.rtrs - write_latency;
  const std::uint32_t next_read_start = t.read_latency + t.dqsck_min;
  const std::uint32_t bus_free = write_data_end + t.rtrs;
  write_to_read_other_rank = bus_free > next_read_start ? bus_free - next_read_start : 1;
  read_to_power_down = latest_read_end + 1;
}

DeviceTiming::DeviceTiming(const Memspec& memspec, const DerivedTiming& derived,
                           std::uint32_t ranks)
    : t_(memspec.timing_cycles),
      d_(derived),
      banks_(memspec.organisation.banks),
      groups_(memspec.organisation.bank_groups),
      banks_per_refresh_(memspec.organisation.banks_per_refresh),
      bank_(std::size_t{ranks} * banks_),
      ranks_(ranks) {}

std::uint64_t DeviceTiming::earliest_precharge_all(std::uint32_t rank) const {
  std::uint64_t earliest = ranks_[rank].earliest[kPre];
  // Closed banks count too: one that closes by auto-precharge still has its recovery to wait for.
  for (std::uint32_t b = 0; b < banks_; ++b)
    earliest = std::max(earliest, bank_of(rank, b).earliest[kPre]);
  return earliest;
}

std::uint64_t DeviceTiming::earliest_refresh_all(std::uint32_t rank) const {
  std::uint64_t earliest = ranks_[rank].refresh;
  for (std::uint32_t b = 0; b < banks_; ++b)
    earliest = std::max(earliest, bank_of(rank, b).earliest[kAct]);
  return earliest;
}

void DeviceTiming::issue(const CommandRecord& r) {
  switch (r.command) {
    case Command::kActivate:
      return activate(r.rank, r.bank, r.row, r.cycle);
    case Command::kRead:
      return read(r.rank, r.bank, r.cycle);
    case Command::kReadAuto:
      read(r.rank, r.bank, r.cycle);
      return close_after_column(r.rank, r.bank);
    case Command::kWrite:
      return write(r.rank, r.bank, r.cycle);
    case Command::kWriteAuto:
      write(r.rank, r.bank, r.cycle);
      return close_after_column(r.rank, r.bank);
    case Command::kPrecharge:
      return precharge(r.rank, r.bank, r.cycle);
    case Command::kPrechargeAll:
      return precharge_all(r.rank, r.cycle);
    case Command::kRefreshAll:
      return refresh_all(r.rank, r.cycle);
    case Command::kRefreshBank:
      return refresh_bank(r.rank, r.bank, r.cycle);
    case Command::kPowerDownEnter:
      return enter_power_down(r.rank, r.cycle);
    case Command::kPowerDownExit:
      return exit_power_down(r.rank, r.cycle);
    case Command::kSelfRefreshEnter:
      return enter_self_refresh(r.rank, r.cycle);
    case Command::kSelfRefreshExit:
      return exit_self_refresh(r.rank, r.cycle);
  }
}

void DeviceTiming::count_activation(Rank& r, std::uint64_t cycle, std::uint32_t to_next) {
  r.faw[r.faw_next] = cycle + t_.faw;
  r.faw_next = (r.faw_next + 1) & 3;
  raise(r.earliest[kAct], std::max(cycle + to_next, r.faw[r.faw_next]));
  raise(r.power_down, cycle + 1);
}

void DeviceTiming::delay_group(RequestCommand command, std::uint32_t rank, std::uint32_t bank,
                               std::uint64_t ready) {
  if (groups_ == 1) return;
  for (std::uint32_t b = bank % groups_; b < banks_; b += groups_)
    raise(bank_of(rank, b).earliest[static_cast<std::size_t>(command)], ready);
}

void DeviceTiming::activate(std::uint32_t rank, std::uint32_t bank, std::uint32_t row,
                            std::uint64_t cycle) {
  Bank& b = bank_of(rank, bank);
  b.open_row = row;
  raise(b.earliest[kRd], cycle + d_.activate_to_read);
  raise(b.earliest[kWr], cycle + d_.activate_to_write);
  raise(b.earliest[kPre], cycle + t_.ras);
  raise(b.earliest[kAct], cycle + t_.rc);
  ++ranks_[rank].open_banks;
  count_activation(ranks_[rank], cycle, t_.rrd);
  delay_group(RequestCommand::kActivate, rank, bank, cycle + t_.rrd_l);
}

void DeviceTiming::read(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle) {
  raise(bank_of(rank, bank).earliest[kPre], cycle + t_.rtp);
  for (Rank& other : ranks_) {
    raise(other.earliest[kRd], cycle + d_.read_to_read_other_rank);
    raise(other.earliest[kWr], cycle + d_.read_to_write_other_rank);
  }
  Rank& r = ranks_[rank];
  r.earliest[kRd] = cycle + t_.ccd;
  r.earliest[kWr] = cycle + d_.read_to_write;
  delay_group(RequestCommand::kRead, rank, bank, cycle + t_.ccd_l);
  raise(r.power_down, cycle + d_.read_to_power_down);
}

void DeviceTiming::write(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle) {
  raise(bank_of(rank, bank).earliest[kPre], cycle + d_.write_to_precharge);
  for (Rank& other : ranks_) {
    raise(other.earliest[kRd], cycle + d_.write_to_read_other_rank);
    raise(other.earliest[kWr], cycle + d_.read_to_read_other_rank);
  }
  Rank& r = ranks_[rank];
  r.earliest[kRd] = cycle + d_.write_to_read;
  r.earliest[kWr] = cycle + t_.ccd;
  delay_group(RequestCommand::kRead, rank, bank, cycle + d_.write_to_read_group);
  delay_group(RequestCommand::kWrite, rank, bank, cycle + d_.write_to_write_group);
  raise(r.power_down, cycle + d_.write_to_precharge);
}

void DeviceTiming::close_after_column(std::uint32_t rank, std::uint32_t bank) {
  Bank& b = bank_of(rank, bank);
  b.open_row = kNoRow;
  raise(b.earliest[kAct], b.earliest[kPre] + t_.rp_bank);
  raise(ranks_[rank].power_down, b.earliest[kPre] + 1);
  --ranks_[rank].open_banks;
}

void DeviceTiming::precharge(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle) {
  Bank& b = bank_of(rank, bank);
  b.open_row = kNoRow;
  raise(b.earliest[kAct], cycle + t_.rp_bank);
  raise(ranks_[rank].power_down, cycle + 1);
  --ranks_[rank].open_banks;
}

void DeviceTiming::precharge_all(std::uint32_t rank, std::uint64_t cycle) {
  for (std::uint32_t i = 0; i < banks_; ++i) {
    Bank& b = bank_of(rank, i);
    b.open_row = kNoRow;
    raise(b.earliest[kAct], cycle + t_.rp_all);
  }
  raise(ranks_[rank].power_down, cycle + 1);
  ranks_[rank].open_banks = 0;
}

void DeviceTiming::refresh_all(std::uint32_t rank, std::uint64_t cycle) {
  Rank& r = ranks_[rank];
  raise(r.earliest[kAct], cycle + t_.rfc_all);
  raise(r.refresh, cycle + t_.rfc_all);
  raise(r.power_down, cycle + t_.rfc_all);
}

void DeviceTiming::refresh_bank(std::uint32_t rank, std::uint32_t bank, std::uint64_t cycle) {
  for (std::uint32_t b = bank; b < bank + banks_per_refresh_; ++b)
    raise(bank_of(rank, b).earliest[kAct], cycle + t_.rfc_bank);
  Rank& r = ranks_[rank];
  raise(r.refresh, cycle + d_.refresh_to_refresh);
  // JESD209-3 counts a per-bank refresh towards tRRD and tFAW.
  count_activation(r, cycle, d_.refresh_to_activate);
  raise(r.power_down, cycle + t_.rfc_bank);
}

void DeviceTiming::enter_power_down(std::uint32_t rank, std::uint64_t cycle) {
  ranks_[rank].exit = cycle + t_.cke;
}

void DeviceTiming::wake(Rank& r, std::uint64_t ready) {
  for (std::uint64_t& earliest : r.earliest) raise(earliest, ready);
  raise(r.refresh, ready);
}

void DeviceTiming::exit_power_down(std::uint32_t rank, std::uint64_t cycle) {
  wake(ranks_[rank], cycle + t_.xp);
  raise(ranks_[rank].power_down, cycle + std::max(t_.cke, t_.xp));
}

void DeviceTiming::enter_self_refresh(std::uint32_t rank, std::uint64_t cycle) {
  ranks_[rank].exit = cycle + t_.cke_self_refresh;
}

void DeviceTiming::exit_self_refresh(std::uint32_t rank, std::uint64_t cycle) {
  wake(ranks_[rank], cycle + t_.xsr);
  raise(ranks_[rank].power_down, cycle + t_.xsr);
}

}  // namespace sgs
