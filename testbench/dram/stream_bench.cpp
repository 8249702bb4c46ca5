// One stream of requests through the TLM socket of a memory, measured.
#include "testbench/dram/stream_bench.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "testbench/dram/closed_loop_driver.h"
#include "testbench/process/in_child.h"
#include "tlm/run_simulation.h"
#include "tlm/time_resolution.h"

namespace sgs {

StreamResult result_of(const DramStats& stats, double wall_s, std::uint64_t requests) {
  StreamResult r;
  const double ns = stats.elapsed_ns();
  const auto bytes = static_cast<double>(stats.bytes());
  const LatencyHistogram& latency = stats.read_latency_cycles.count() > 0
                                        ? stats.read_latency_cycles
                                        : stats.write_latency_cycles;
  r.gb_per_s = stats.bandwidth_gb_per_s();
  r.busy_gb_per_s = stats.busy_bandwidth_gb_per_s();
  r.peak_gb_per_s = stats.peak_gb_per_s;
  r.bus_gb_per_s = static_cast<double>(stats.bus_bytes()) / ns;
  r.row_hit_rate = stats.row_hit_rate();
  r.latency_mean_ns = latency.mean() * stats.clock_period_ns;
  r.latency_p50_ns = static_cast<double>(latency.percentile(0.5)) * stats.clock_period_ns;
  r.latency_p99_ns = static_cast<double>(latency.percentile(0.99)) * stats.clock_period_ns;
  r.power_mw = stats.energy.total_pj() / ns;
  r.vdd2_power_mw = stats.energy.vdd2.total_pj() / ns;
  r.pj_per_bit = stats.energy.total_pj() / (8 * bytes);
  r.band_low_mw = r.band_high_mw = r.power_mw;
  for (const auto& set : stats.energy_by_current_set_pj) {
    r.band_low_mw = std::min(r.band_low_mw, set.second / ns);
    r.band_high_mw = std::max(r.band_high_mw, set.second / ns);
  }
  r.wall_s = wall_s;
  r.requests = requests;
  return r;
}

DramStats run_stream(const StreamBench& bench, double& wall_s) {
  DramController dram("dram", bench.dram);
  std::unique_ptr<CommandTraceWriter> trace;
  if (bench.dram_trace != nullptr) {
    trace = std::make_unique<CommandTraceWriter>(*bench.dram_trace,
                                                 CommandTraceHeader::of(bench.dram), dram);
  }
  RequestGenerator generator(bench.stream);
  ClosedLoopDriver::Config config;
  config.window = bench.window;
  config.requests = bench.requests;
  config.request_bytes = bench.stream.request_bytes;
  config.burst_bytes = dram.memspec().burst_bytes();
  config.clock_period = sc_core::sc_time(dram.memspec().clock_period_ns, sc_core::SC_NS);
  std::function<MemoryRequest()> next = bench.next;
  if (!next) next = [&] { return generator.next(); };
  ClosedLoopDriver driver("driver", config, next);
  driver.socket.bind(dram.socket);
  const auto start = std::chrono::steady_clock::now();
  run_simulation();
  wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (trace) trace->close();
  const DramStats stats = dram.stats();
  if (driver.answered() != bench.requests || !dram.idle())
    throw std::runtime_error("stream: not every request was answered");
  return stats;
}

StreamResult run_stream_in_child(const StreamBench& bench) {
  const std::string bytes = in_child([&] {
    use_femtosecond_resolution();
    double wall_s = 0;
    const DramStats stats = run_stream(bench, wall_s);
    const StreamResult result = result_of(stats, wall_s, bench.requests);
    return std::string(reinterpret_cast<const char*>(&result), sizeof result);
  });
  StreamResult result;
  std::memcpy(&result, bytes.data(), sizeof result);
  return result;
}

}  // namespace sgs
