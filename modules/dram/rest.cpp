// A channel's maintenance alone, with its policy for the time between frames.
#include "modules/dram/rest.h"

#include <algorithm>

#include "modules/dram/device_timing.h"
#include "modules/dram/rank_maintenance.h"

namespace sgs {
namespace {

struct Meter : CommandSink {
  Meter(const Memspec& memspec, const DramConfig& config) : activity(memspec, config) {}
  void on_command(const CommandRecord& record) override { activity.on_command(record); }
  ActivityMeter activity;
};

class RestingChannel {
 public:
  RestingChannel(const DramConfig& config, const Memspec& memspec, std::uint8_t channel,
                 CommandSink& sink)
      : channel_(channel),
        sink_(sink),
        device_(memspec, DerivedTiming(memspec, config.write_latency_set, config.read_strobe),
                config.ranks) {
    for (std::uint32_t rank = 0; rank < config.ranks; ++rank)
      maintenance_.emplace_back(config, memspec, rank);
  }

  // Ranks are wanted from `wanted_from` on.
  void run(std::uint64_t wanted_from, std::uint64_t until) {
    for (std::uint32_t rank = 0; rank < device_.ranks() && clock_ < until; ++rank)
      send({clock_, Command::kPrechargeAll, rank, 0});
    while (true) {
      Candidate first;
      for (const RankMaintenance& rank : maintenance_) {
        // Those that waking asks for are paid before the end.
        const Candidate owed = rank.owed_refresh(device_, clock_);
        Candidate next = owed.cycle != kNever ? owed : rank.next(device_, wanted_from, clock_);
        next.cycle = std::max(next.cycle, clock_);
        if (next.cycle < first.cycle) first = next;
      }
      if (first.cycle >= until) return;
      send(first);
    }
  }

 private:
  void send(const Candidate& c) {
    const CommandRecord record{c.cycle,
                               c.command,
                               channel_,
                               static_cast<std::uint8_t>(c.rank),
                               static_cast<std::uint8_t>(c.bank),
                               0,
                               0,
                               0};
    device_.issue(record);
    maintenance_[c.rank].on_command(c.command, c.cycle);
    sink_.on_command(record);
    clock_ = c.cycle + 1;
  }

  const std::uint8_t channel_;
  CommandSink& sink_;
  DeviceTiming device_;
  std::vector<RankMaintenance> maintenance_;
  std::uint64_t clock_ = 0;
};

// The cycle from which ranks must wake to be up at the end; 0 where the rest has no room for sleep.
std::uint64_t wake_cycle(const DramConfig& config, const Memspec& memspec, std::uint64_t cycles) {
  const Memspec::Timing& t = memspec.timing_cycles;
  std::uint64_t least = t.cke, ready = t.xp;
  if (config.self_refresh_idle_cycles > 0) {
    const std::uint32_t apart = t.pbr2pbr > 0 ? t.pbr2pbr : t.rfc_bank;
    const std::uint32_t each = (memspec.refresh_sets() - 1) * apart + t.rfc_bank;
    const std::uint32_t refreshes = config.refresh == RefreshMode::kAllBank ? t.rfc_all : each;
    least = t.cke_self_refresh;
    ready = t.xsr + (config.refresh == RefreshMode::kOff ? 0 : refreshes);
  }
  ready += config.ranks - 1;  // one command a cycle
  return cycles > config.ranks + t.rp_all + least + ready ? cycles - ready : 0;
}

template <class Cycles>
double share_of(const Rest& rest, const Cycles& cycles_of) {
  if (rest.cycles == 0) return 0;
  double cycles = 0;
  for (const RankActivity& rank : rest.ranks) cycles += static_cast<double>(cycles_of(rank));
  return cycles / (static_cast<double>(rest.cycles) * static_cast<double>(rest.ranks.size()));
}

}  // namespace

double Rest::self_refresh() const {
  return share_of(*this, [](const RankActivity& rank) { return rank.self_refresh_cycles; });
}

double Rest::power_down() const {
  return share_of(*this, [](const RankActivity& rank) {
    return rank.active_power_down_cycles + rank.precharged_power_down_cycles;
  });
}

Rest rest_of(const DramConfig& config, const Memspec& memspec, std::uint64_t cycles) {
  const DramConfig resting = config.at_rest();
  Meter meter(memspec, resting);
  for (std::uint32_t bus = 0; bus < resting.buses(memspec); ++bus) {
    RestingChannel channel(resting, memspec, static_cast<std::uint8_t>(bus), meter);
    channel.run(wake_cycle(resting, memspec, cycles), cycles);
  }
  Rest rest;
  rest.cycles = cycles;
  rest.ranks = meter.activity.ranks(cycles);
  rest.energy = dram_energy_band(memspec, resting, rest.ranks, meter.activity.regions());
  return rest;
}

}  // namespace sgs
