// A memory's counts as a table with units.
#include "testbench/dram/stats_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace sgs {

namespace {
// fmt::format to the end of a text.
template <class... Values>
void add(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

void latency_line(std::string& text, const char* name, const LatencyHistogram& h, double clock_ns) {
  if (h.count() == 0) return;
  add(text, "{:<24} {:>10.1f} / {:.1f} / {:.1f} / {:.1f}  ns (mean, p50, p99, max)\n", name,
      h.mean() * clock_ns, static_cast<double>(h.percentile(0.5)) * clock_ns,
      static_cast<double>(h.percentile(0.99)) * clock_ns, static_cast<double>(h.max()) * clock_ns);
}
}  // namespace

std::string stats_table(const DramStats& s) {
  std::string text;
  const DramChannelStats all = s.all_channels();
  const double ns = s.elapsed_ns();
  const auto count = [&text](const char* name, std::uint64_t value, const char* unit) {
    add(text, "{:<24} {:>14}  {}\n", name, value, unit);
  };
  count("time", s.elapsed_cycles, "clock cycles");
  add(text, "{:<24} {:>14.3f}  us\n", "", ns / 1000);
  count("transactions", s.traffic.total().transactions, "");
  count("bytes asked for", s.bytes(), "bytes");
  count("bytes on the bus", s.bus_bytes(), "bytes (whole bursts)");
  add(text, "{:<24} {:>14.3f}  GB/s (bytes / total time)\n", "bandwidth", s.bandwidth_gb_per_s());
  add(text, "{:<24} {:>14.3f}  GB/s (bytes / time with a request inside)\n", "busy bandwidth",
      s.busy_bandwidth_gb_per_s());
  add(text, "{:<24} {:>14.3f}  GB/s\n", "peak", s.peak_gb_per_s);
  latency_line(text, "read latency", s.read_latency_cycles, s.clock_period_ns);
  latency_line(text, "write latency", s.write_latency_cycles, s.clock_period_ns);
  count("row hits", all.rows.of(RowOutcome::kHit), "bursts");
  count("row misses", all.rows.of(RowOutcome::kMiss), "bursts (bank was closed)");
  count("row conflicts", all.rows.of(RowOutcome::kConflict), "bursts (another row was open)");
  count("forwarded reads", s.forwarded_reads, "requests (from the write queue)");
  count("activates", all.activates(), "");
  count("refreshes", all.refreshes(), "");
  for (std::size_t c = 0; c < s.channels.size(); ++c)
    add(text, "{:<24} {:>14.1f}  % of time\n", fmt::format("data bus {} busy", c),
        s.elapsed_cycles == 0 ? 0.0
                              : 100.0 * static_cast<double>(s.channels[c].busy_cycles) /
                                    static_cast<double>(s.elapsed_cycles));
  EnergyParts parts = s.energy.vdd1;
  parts += s.energy.vdd2;
  const auto energy = [&](const char* name, double pj) {
    add(text, "{:<24} {:>14.3f}  uJ\n", name, pj / 1e6);
  };
  if (!s.energy.not_stated.empty()) {
    add(text, "{:<24} not known: the memspec does not state {}\n", "energy", s.energy.not_stated);
    return text;
  }
  energy("energy", parts.total_pj());
  energy("  activate, precharge", parts.activate_pj);
  energy("  read", parts.read_pj);
  energy("  write", parts.write_pj);
  energy("  refresh", parts.refresh_pj);
  energy("  active standby", parts.active_standby_pj);
  energy("  precharged standby", parts.precharged_standby_pj);
  energy("  power-down", parts.power_down_pj);
  energy("  self-refresh", parts.self_refresh_pj);
  if (parts.io_pj > 0) energy("  I/O (stated adder)", parts.io_pj);
  for (const auto& set : s.energy.by_current_set_pj)
    energy(fmt::format("energy by {}", set.first).c_str(), set.second);
  return text;
}

}  // namespace sgs
