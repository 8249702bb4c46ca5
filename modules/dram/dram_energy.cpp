// Energy of DRAM: state residencies from commands, joules from currents.
#include "modules/dram/dram_energy.h"

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "modules/dram/device_timing.h"

namespace sgs {

EnergyParts& EnergyParts::operator+=(const EnergyParts& o) {
  activate_pj += o.activate_pj;
  read_pj += o.read_pj;
  write_pj += o.write_pj;
  refresh_pj += o.refresh_pj;
  active_standby_pj += o.active_standby_pj;
  precharged_standby_pj += o.precharged_standby_pj;
  power_down_pj += o.power_down_pj;
  self_refresh_pj += o.self_refresh_pj;
  io_pj += o.io_pj;
  return *this;
}

ActivityMeter::ActivityMeter(const Memspec& memspec, const DramConfig& config)
    : t_(memspec.timing_cycles),
      write_to_precharge_(
          DerivedTiming(memspec, config.write_latency_set, config.read_strobe).write_to_precharge),
      ranks_per_channel_(config.ranks),
      state_(std::size_t{config.buses(memspec)} * config.ranks),
      activated_(state_.size() * memspec.organisation.banks),
      banks_(memspec.organisation.banks) {}

void ActivityMeter::end_active(State& s, std::uint64_t cycle) {
  if (!s.active) return;
  s.done.active_cycles += cycle - s.active_since;
  s.active = false;
}

void ActivityMeter::begin_active(State& s, std::uint64_t cycle) const {
  if (s.active && s.open_banks == 0 && s.active_until < cycle) end_active(s, s.active_until);
  if (s.active) return;
  s.active = true;
  s.active_since = cycle;
}

void ActivityMeter::close(State& s, std::uint32_t bank, std::uint64_t cycle) const {
  s.open_banks &= ~(std::uint64_t{1} << bank);
  s.active_until = std::max(s.active_until, cycle);
}

void ActivityMeter::end_low(State& s, std::uint64_t cycle) {
  const std::uint64_t cycles = cycle - s.low_since;
  if (s.low == Low::kActivePowerDown) s.done.active_power_down_cycles += cycles;
  if (s.low == Low::kPrechargedPowerDown) s.done.precharged_power_down_cycles += cycles;
  if (s.low == Low::kSelfRefresh) s.done.self_refresh_cycles += cycles;
  s.low = Low::kNone;
}

void ActivityMeter::on_command(const CommandRecord& r) {
  const std::size_t index = std::size_t{r.channel} * ranks_per_channel_ + r.rank;
  State& s = state_[index];
  std::uint64_t& activated = activated_[index * banks_ + r.bank];
  const bool read = is_read(r.command);
  if (read || is_write(r.command)) {
    ++(read ? s.done.reads : s.done.writes);
    ++(read ? regions_[r.region].reads : regions_[r.region].writes);
  }
  switch (r.command) {
    case Command::kActivate:
      begin_active(s, r.cycle);
      s.open_banks |= std::uint64_t{1} << r.bank;
      activated = r.cycle;
      ++s.done.activates;
      ++regions_[r.region].activates;
      break;
    case Command::kReadAuto:
      close(s, r.bank, std::max(r.cycle + t_.rtp, activated + t_.ras));
      break;
    case Command::kWriteAuto:
      close(s, r.bank, std::max(r.cycle + write_to_precharge_, activated + t_.ras));
      break;
    case Command::kPrecharge:
      close(s, r.bank, r.cycle);
      break;
    case Command::kPrechargeAll:
      s.open_banks = 0;
      s.active_until = std::max(s.active_until, r.cycle);
      break;
    case Command::kRefreshAll:
    case Command::kRefreshBank: {
      const bool all = r.command == Command::kRefreshAll;
      begin_active(s, r.cycle);
      s.active_until = std::max(s.active_until, r.cycle + (all ? t_.rfc_all : t_.rfc_bank));
      ++(all ? s.done.refreshes_all : s.done.refreshes_bank);
      break;
    }
    case Command::kPowerDownEnter:
      s.low = s.open_banks != 0 ? Low::kActivePowerDown : Low::kPrechargedPowerDown;
      s.low_since = r.cycle;
      end_active(s, s.open_banks != 0 ? r.cycle : std::min(s.active_until, r.cycle));
      break;
    case Command::kSelfRefreshEnter:
      s.low = Low::kSelfRefresh;
      s.low_since = r.cycle;
      end_active(s, std::min(s.active_until, r.cycle));
      break;
    case Command::kPowerDownExit:
    case Command::kSelfRefreshExit:
      end_low(s, r.cycle);
      if (s.open_banks != 0) begin_active(s, r.cycle);
      break;
    case Command::kRead:
    case Command::kWrite:
      break;
  }
}

std::vector<RankActivity> ActivityMeter::ranks(std::uint64_t cycle) const {
  std::vector<RankActivity> all;
  for (State s : state_) {
    if (s.low != Low::kNone) end_low(s, cycle);
    end_active(s, s.open_banks != 0 ? cycle : std::min(s.active_until, cycle));
    RankActivity& a = s.done;
    a.precharged_cycles = cycle - a.active_cycles - a.active_power_down_cycles -
                          a.precharged_power_down_cycles - a.self_refresh_cycles;
    all.push_back(a);
  }
  return all;
}

namespace {

// Energy of one event or cycle on one rail.
struct EventEnergy {
  EventEnergy(const Memspec& m, const Memspec::Rail& i, double volts) {
    const Memspec::Timing& t = m.timing_cycles;
    cycle = volts * m.clock_period_ns;
    activate = cycle * (i.idd0 * t.rc - i.idd3n * t.ras - i.idd2n * (t.rc - t.ras));
    read = cycle * (i.idd4r - i.idd3n) * m.burst_cycles();
    write = cycle * (i.idd4w - i.idd3n) * m.burst_cycles();
    refresh_all = cycle * (i.idd5 - i.idd3n) * t.rfc_all;
    refresh_bank = refresh_all / (m.refresh_sets() * m.refreshes_of_set());
  }
  double cycle, activate, read, write, refresh_all, refresh_bank;
};

EnergyParts parts_of(const EventEnergy& e, const Memspec::Rail& i, const RankActivity& a) {
  EnergyParts p;
  p.activate_pj = e.activate * static_cast<double>(a.activates);
  p.read_pj = e.read * static_cast<double>(a.reads);
  p.write_pj = e.write * static_cast<double>(a.writes);
  p.refresh_pj = e.refresh_all * static_cast<double>(a.refreshes_all) +
                 e.refresh_bank * static_cast<double>(a.refreshes_bank);
  p.active_standby_pj = e.cycle * i.idd3n * static_cast<double>(a.active_cycles);
  p.precharged_standby_pj = e.cycle * i.idd2n * static_cast<double>(a.precharged_cycles);
  p.power_down_pj = e.cycle * (i.idd3p * static_cast<double>(a.active_power_down_cycles) +
                               i.idd2p * static_cast<double>(a.precharged_power_down_cycles));
  p.self_refresh_pj = e.cycle * i.idd6 * static_cast<double>(a.self_refresh_cycles);
  return p;
}

}  // namespace

DramEnergy dram_energy(const Memspec& m, const Memspec::Currents& c,
                       const std::vector<RankActivity>& ranks,
                       const std::array<RegionActivity, 256>& regions, double io_pj_per_bit) {
  const EventEnergy e1(m, c.vdd1_ma, c.vdd1_v);
  const EventEnergy e2(m, c.vdd2_ma, c.vdd2_v);
  const double io_burst_pj = io_pj_per_bit * 8.0 * m.burst_bytes();
  DramEnergy sum;
  for (const RankActivity& a : ranks) {
    const EnergyParts rail1 = parts_of(e1, c.vdd1_ma, a);
    EnergyParts rail2 = parts_of(e2, c.vdd2_ma, a);
    rail2.io_pj = io_burst_pj * static_cast<double>(a.reads + a.writes);
    sum.vdd1 += rail1;
    sum.vdd2 += rail2;
    EnergyParts both = rail1;
    both += rail2;
    sum.shared_pj += both.refresh_pj + both.active_standby_pj + both.precharged_standby_pj +
                     both.power_down_pj + both.self_refresh_pj;
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
    sum.by_region_pj[r] =
        (e1.activate + e2.activate) * static_cast<double>(regions[r].activates) +
        (e1.read + e2.read + io_burst_pj) * static_cast<double>(regions[r].reads) +
        (e1.write + e2.write + io_burst_pj) * static_cast<double>(regions[r].writes);
  return sum;
}

namespace {

// As DramEnergyBand::not_stated. I/O: the memory's, or a number that is given, were it 0.
std::string not_stated(const Memspec::Currents& c, const std::vector<RankActivity>& ranks,
                       bool io_stated) {
  using Rail = Memspec::Rail;
  using Count = std::uint64_t RankActivity::*;
  struct Use {
    const char* name;
    double Rail::*ma;
    std::vector<Count> counts;
  };
  const auto takes_place = [&](Count count) {
    return std::any_of(ranks.begin(), ranks.end(),
                       [&](const RankActivity& rank) { return rank.*count > 0; });
  };
  const auto is_needed = [&](const std::vector<Count>& counts) {
    return std::any_of(counts.begin(), counts.end(), takes_place);
  };
  using Done = RankActivity;
  const std::vector<Count> bursts = {&Done::reads, &Done::writes};
  std::vector<std::string> missing;
  bool any = false;
  for (const Use& use :
       std::vector<Use>{{"idd0", &Rail::idd0, {&Done::activates}},
                        {"idd2p", &Rail::idd2p, {&Done::precharged_power_down_cycles}},
                        {"idd2n", &Rail::idd2n, {&Done::precharged_cycles}},
                        {"idd3p", &Rail::idd3p, {&Done::active_power_down_cycles}},
                        {"idd3n", &Rail::idd3n, {&Done::active_cycles}},
                        {"idd4r", &Rail::idd4r, {&Done::reads}},
                        {"idd4w", &Rail::idd4w, {&Done::writes}},
                        {"idd5", &Rail::idd5, {&Done::refreshes_all, &Done::refreshes_bank}},
                        {"idd6", &Rail::idd6, {&Done::self_refresh_cycles}}}) {
    const bool stated = c.vdd1_ma.*use.ma > 0 || c.vdd2_ma.*use.ma > 0;
    any = any || stated;
    if (!stated && is_needed(use.counts)) missing.emplace_back(use.name);
  }
  if (!any && !missing.empty()) missing = {"currents"};
  if (!io_stated && is_needed(bursts)) missing.emplace_back("I/O energy (dram.io_pj_per_bit)");
  return join(missing, " and ");
}

}  // namespace

DramEnergyBand dram_energy_band(const Memspec& m, const DramConfig& config,
                                const std::vector<RankActivity>& ranks,
                                const std::array<RegionActivity, 256>& regions) {
  const std::string& chosen = config.current_set.empty() ? m.default_currents : config.current_set;
  const IoEnergy io = config.io_pj_per_bit_of(m);
  const double spread = m.spread_of_currents();
  std::uint64_t bursts = 0;
  for (const RankActivity& a : ranks) bursts += a.reads + a.writes;
  const double bits = 8.0 * m.burst_bytes() * static_cast<double>(bursts);
  DramEnergyBand band;
  for (const auto& [name, currents] : m.currents) {
    const DramEnergy energy = dram_energy(m, currents, ranks, regions, io.middle);
    const double by_currents_pj = energy.total_pj() - energy.vdd2.io_pj;
    const double least_pj = by_currents_pj / spread + bits * io.low;
    const bool first = band.by_current_set_pj.empty();
    band.least_pj = first ? least_pj : std::min(band.least_pj, least_pj);
    band.most_pj = std::max(band.most_pj, by_currents_pj * spread + bits * io.high);
    band.by_current_set_pj[name] = energy.total_pj();
    if (name != chosen) continue;
    static_cast<DramEnergy&>(band) = energy;
    band.not_stated = not_stated(currents, ranks, config.io_pj_per_bit || m.io_pj_per_bit > 0);
  }
  // With a band of no width, sums in another order may differ in their last digit.
  band.least_pj = std::min(band.least_pj, band.total_pj());
  band.most_pj = std::max(band.most_pj, band.total_pj());
  return band;
}

}  // namespace sgs
