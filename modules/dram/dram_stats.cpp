// Rates derived from the memory's counts.
#include "modules/dram/dram_stats.h"

namespace sgs {

namespace {

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

}  // namespace

DramChannelStats DramStats::all_channels() const {
  DramChannelStats sum;
  for (const DramChannelStats& channel : channels) {
    for (std::size_t i = 0; i < sum.rows.bursts.size(); ++i)
      sum.rows.bursts[i] += channel.rows.bursts[i];
    for (std::size_t i = 0; i < kCommands; ++i) sum.commands[i] += channel.commands[i];
    sum.busy_cycles += channel.busy_cycles;
  }
  return sum;
}

double DramStats::bandwidth_gb_per_s() const {
  return ratio(static_cast<double>(bytes()), elapsed_ns());
}

double DramStats::busy_bandwidth_gb_per_s() const {
  return ratio(static_cast<double>(bytes()), static_cast<double>(busy_cycles) * clock_period_ns);
}

double DramStats::row_hit_rate() const {
  const RowCounts rows = all_channels().rows;
  return ratio(static_cast<double>(rows.of(RowOutcome::kHit)), static_cast<double>(rows.total()));
}

}  // namespace sgs
