// One stream of requests through the TLM socket of a memory, measured.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "algorithm/files/output_file.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/dram_stats.h"
#include "modules/dram/request_trace.h"
#include "tlm/payload_pool.h"

namespace sgs {

// Request streams for memory benchmarks, defined to the bit so that other simulators can be given
// the same ones.
enum class Pattern { kRandom, kSequential, kStride };

struct StreamSpec {
  Pattern pattern = Pattern::kRandom;
  std::uint32_t request_bytes = 32;
  std::uint64_t stride_bytes = 0;  // kStride only
  std::uint64_t span_bytes = std::uint64_t{1} << 29;
  std::uint32_t write_percent = 0;
};

// xorshift64*, one draw a request whatever the pattern. Random: address = ((q >> 11) mod
// (span / size)) * size. Sequential: i * size mod span. Stride S: i S mod span, moved on by one
// request each time round, within the stride. A write when (q >> 1) mod 100 < write_percent.
class RequestGenerator {
 public:
  explicit RequestGenerator(const StreamSpec& spec) : spec_(spec) {}
  MemoryRequest next();

 private:
  const StreamSpec spec_;
  std::uint64_t state_ = 88172645463325252u;
  std::uint64_t index_ = 0;
};

// xorshift64* by itself: steps `state` and returns the draw.
std::uint64_t xorshift64star(std::uint64_t& state);

// Drives a memory as hard as a window of outstanding requests allows.

// Requests go out in order, none before its time; a held-back END_REQ stops the stream; at most
// kBurstsPerCycle bursts of requests are offered in one clock cycle.
class ClosedLoopDriver : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<ClosedLoopDriver> socket;

  struct Config {
    std::uint32_t window = 32;  // requests without an answer
    std::uint64_t requests = 0;
    std::uint32_t request_bytes = 32;  // for requests that state no size
    std::uint32_t burst_bytes = 32;
    sc_core::sc_time clock_period;
  };

  SC_HAS_PROCESS(ClosedLoopDriver);
  // `next` yields the requests one after the other.
  ClosedLoopDriver(const sc_core::sc_module_name& name, const Config& config,
                   std::function<MemoryRequest()> next);

  std::uint64_t answered() const { return answered_; }

 private:
  static constexpr std::uint32_t kBurstsPerCycle = 8;

  void offer();
  std::uint32_t bytes_of(const MemoryRequest& request) const {
    return request.bytes != 0 ? request.bytes : config_.request_bytes;
  }
  void send();
  void on_answer(tlm::tlm_generic_payload& payload);
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);

  const Config config_;
  const std::function<MemoryRequest()> next_;
  PayloadPool pool_;
  std::vector<std::uint8_t> data_;
  sc_core::sc_event may_offer_;
  MemoryRequest request_;  // the next to be sent
  std::uint64_t sent_ = 0;
  std::uint64_t answered_ = 0;
  const tlm::tlm_generic_payload* held_back_ = nullptr;  // waits for its END_REQ
};

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
  double gb_per_s = 0;  // bytes asked for over all the time
  double peak_gb_per_s = 0;
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
