// From DramStats to MemoryResult.
#include "testbench/result/collect_memory.h"

#include <algorithm>
#include <utility>

#include "modules/dram/queued_channel.h"

namespace sgs {

namespace {

class Paths : public DataSheet {
 public:
  void port(MemoryPort& port, const char*) override {
    constexpr double kDirections = 2, kByteBits = 8;
    const MemoryPortConfig& config = port.config();
    const double bits = kDirections * kByteBits * config.width_bytes;
    const double moved = kByteBits * static_cast<double>(port.bytes_read() + port.bytes_written());
    wide += bits;
    passed += moved;
    registers += bits * config.path_cycles;
    registered += moved * config.path_cycles;
    if (!config.urgent) return;
    urgent = true;
    urgent_requests += static_cast<double>(port.transactions());
  }
  double wide = 0, passed = 0;           // bits of all ports, and through them
  double registers = 0, registered = 0;  // the same of the stages
  double urgent_requests = 0;
  bool urgent = false;  // a port
};

RegionTraffic& entry(std::vector<RegionTraffic>& traffic, const std::string& region,
                     const std::string& requester) {
  for (RegionTraffic& t : traffic) {
    if (t.region == region && t.requester == requester) return t;
  }
  traffic.push_back({region, requester, 0, 0});
  return traffic.back();
}

void add_states(const DramStats& stats, MemoryResult& m) {
  constexpr double kPj = 1e-12, kNs = 1e-9;
  EnergyParts e = stats.energy.vdd1;
  e += stats.energy.vdd2;
  RankActivity all;
  for (const RankActivity& rank : stats.ranks) {
    all.active_cycles += rank.active_cycles;
    all.precharged_cycles += rank.precharged_cycles;
    all.active_power_down_cycles += rank.active_power_down_cycles;
    all.precharged_power_down_cycles += rank.precharged_power_down_cycles;
    all.self_refresh_cycles += rank.self_refresh_cycles;
  }
  const auto seconds = [&](std::uint64_t cycles) {
    return kNs * stats.clock_period_ns * static_cast<double>(cycles) /
           static_cast<double>(stats.ranks.size());
  };
  m.states = {
      {"active", seconds(all.active_cycles), kPj * e.active_standby_pj},
      {"precharged", seconds(all.precharged_cycles), kPj * e.precharged_standby_pj},
      {"power_down", seconds(all.active_power_down_cycles + all.precharged_power_down_cycles),
       kPj * e.power_down_pj},
      {kSelfRefreshState, seconds(all.self_refresh_cycles), kPj * e.self_refresh_pj}};
  m.commands = {{"activate", kPj * e.activate_pj},
                {"read", kPj * e.read_pj},
                {"write", kPj * e.write_pj},
                {"refresh", kPj * e.refresh_pj},
                {"io", kPj * e.io_pj}};
}

}  // namespace

void add_memory_path(const Publisher& all, std::uint32_t channels, MachineResult& result) {
  constexpr const char* kComponent = "memory_path";
  Paths paths;
  all(paths);
  if (paths.wide == 0) return;
  OwnerResult owner{kComponent, {}, {}};
  if (paths.urgent) {
    constexpr double kEntryBits = 64;  // as in a port's table
    const double bits = channels * kUrgentEntries * kEntryBits;
    const double used = kEntryBits * paths.urgent_requests;
    paths.registers += bits;
    paths.registered += used;
    owner.parts.push_back({kComponent, "select_bit", bits, bits});
    result.operations.push_back({kComponent, "select_bit", used});
  }
  if (paths.registers > 0) {
    owner.parts.push_back({kComponent, "register_bit", paths.registers, paths.registers});
    result.operations.push_back({kComponent, "register_bit", paths.registered});
  }
  // A bit passes one of its channels' multiplexers.
  owner.parts.push_back({kComponent, "crossbar_bit", channels * paths.wide, paths.wide});
  result.operations.push_back({kComponent, "crossbar_bit", paths.passed});
  result.parts.insert(result.parts.end(), owner.parts.begin(), owner.parts.end());
  result.owners.push_back(std::move(owner));
}

MemoryResult collect_memory(const DramStats& stats, const Regions& regions,
                            const std::vector<std::string>& requesters) {
  constexpr double kPj = 1e-12;
  const DramChannelStats all = stats.all_channels();
  const auto latency_ns = [&](double fraction) {
    return static_cast<double>(stats.read_latency_cycles.percentile(fraction)) *
           stats.clock_period_ns;
  };
  MemoryResult m;
  m.remedy = "dram.channels";
  m.bytes = stats.bytes();
  m.bus_bytes = stats.bus_bytes();
  for (const auto& row : stats.traffic.rows()) {
    RegionTraffic& t = entry(m.traffic, regions[row.region].name, requesters[row.requester]);
    (row.direction == Direction::kRead ? t.read_bytes : t.written_bytes) = row.count.bytes;
  }
  for (std::size_t id = 0; id < regions.size(); ++id) {
    const std::string& name = regions[static_cast<RegionId>(id)].name;
    m.bus_bytes_by_region.emplace_back(
        name, (stats.bursts_by_region[id][0] + stats.bursts_by_region[id][1]) * stats.burst_bytes);
    m.energy_by_region_j.emplace_back(name, stats.energy.by_region_pj[id] * kPj);
  }
  m.energy_by_region_j.emplace_back("standby_and_refresh", stats.energy.shared_pj * kPj);
  for (const auto& [set, pj] : stats.energy.by_current_set_pj) {
    m.energy_by_current_set_j.emplace_back(set, pj * kPj);
  }
  m.energy_j = stats.energy.total_pj() * kPj;
  m.energy_least_j = stats.energy.least_pj * kPj;
  m.energy_most_j = stats.energy.most_pj * kPj;
  m.energy_not_stated = stats.energy.not_stated;
  add_states(stats, m);
  m.transactions = stats.traffic.total().transactions;
  m.row_hits = all.rows.of(RowOutcome::kHit);
  m.row_misses = all.rows.of(RowOutcome::kMiss);
  m.row_conflicts = all.rows.of(RowOutcome::kConflict);
  m.refreshes = all.refreshes();
  m.bandwidth_gb_s = stats.bandwidth_gb_per_s();
  m.busy_bandwidth_gb_s = stats.busy_bandwidth_gb_per_s();
  m.channels = static_cast<std::uint32_t>(stats.channels.size());
  m.peak_gb_s = stats.peak_gb_per_s;
  m.read_latency_mean_ns = stats.read_latency_cycles.mean() * stats.clock_period_ns;
  m.read_latency_p50_ns = latency_ns(0.5);
  m.read_latency_p99_ns = latency_ns(0.99);
  std::uint64_t busiest = 0;
  for (const DramChannelStats& channel : stats.channels) {
    busiest = std::max(busiest, channel.busy_cycles);
  }
  if (stats.elapsed_cycles > 0) {
    m.bus_utilisation = static_cast<double>(busiest) / static_cast<double>(stats.elapsed_cycles);
  }
  return m;
}

}  // namespace sgs
