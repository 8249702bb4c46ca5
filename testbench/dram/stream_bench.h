// One stream of requests through the TLM socket of a memory, measured.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "modules/dram/dram_config.h"
#include "modules/dram/dram_stats.h"
#include "testbench/dram/request_generator.h"

namespace sgs {

struct StreamBench {
  DramConfig dram;
  StreamSpec stream;
  std::uint32_t window = 32;
  std::uint64_t requests = 1000000;
  OutputFile* dram_trace = nullptr;     // null: none
  std::function<MemoryRequest()> next;  // instead of the stream's requests, when set
};

// Plain numbers, so that they can cross a pipe.
struct StreamResult {
  double gb_per_s = 0;       // bytes asked for over all the time
  double busy_gb_per_s = 0;  // over the time with a request in the controller
  double peak_gb_per_s = 0;
  double bus_gb_per_s = 0;  // whole bursts over all the time
  double row_hit_rate = 0;
  double latency_mean_ns = 0;  // reads; writes when there are no reads
  double latency_p50_ns = 0;
  double latency_p99_ns = 0;
  double power_mw = 0;  // both rails
  double vdd2_power_mw = 0;
  double pj_per_bit = 0;   // both rails
  double band_low_mw = 0;  // over the published sets of currents
  double band_high_mw = 0;
  double wall_s = 0;
  std::uint64_t requests = 0;
};

StreamResult result_of(const DramStats& stats, double wall_s, std::uint64_t requests);

// Elaborates and simulates here: once a process, after use_femtosecond_resolution().
DramStats run_stream(const StreamBench& bench, double& wall_s);

// Runs it in a child process, because SystemC elaborates once in each. std::runtime_error when the
// child fails.
StreamResult run_stream_in_child(const StreamBench& bench);

}  // namespace sgs
