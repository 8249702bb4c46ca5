// One stream of requests through the TLM socket of a memory, measured.
#include "testbench/dram/stream_bench.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "testbench/process/child_process.h"
#include "tlm/run_simulation.h"
#include "tlm/time_resolution.h"

namespace sgs {

std::uint64_t xorshift64star(std::uint64_t& state) {
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * 2685821657736338717u;
}

MemoryRequest RequestGenerator::next() {
  const std::uint64_t q = xorshift64star(state_);
  const std::uint64_t i = index_++;
  const std::uint64_t size = spec_.request_bytes;
  MemoryRequest request;
  request.write = (q >> 1) % 100 < spec_.write_percent;
  switch (spec_.pattern) {
    case Pattern::kRandom:
      request.address = (q >> 11) % (spec_.span_bytes / size) * size;
      break;
    case Pattern::kSequential:
      request.address = i * size % spec_.span_bytes;
      break;
    case Pattern::kStride: {
      const std::uint64_t along = i * spec_.stride_bytes;
      request.address =
          along % spec_.span_bytes + along / spec_.span_bytes * size % spec_.stride_bytes;
      break;
    }
  }
  return request;
}

ClosedLoopDriver::ClosedLoopDriver(const sc_core::sc_module_name& name, const Config& config,
                                   std::function<MemoryRequest()> next)
    : sc_module(name),
      socket("socket"),
      config_(config),
      next_(std::move(next)),
      data_(config.request_bytes) {
  socket.register_nb_transport_bw(this, &ClosedLoopDriver::nb_transport_bw);
  SC_METHOD(offer);
  sensitive << may_offer_;
  if (config.requests > 0) request_ = next_();
}

void ClosedLoopDriver::offer() {
  std::uint32_t offered = 0;  // bursts, in this cycle
  while (held_back_ == nullptr && sent_ < config_.requests && sent_ - answered_ < config_.window) {
    const std::uint32_t bursts =
        (bytes_of(request_) + config_.burst_bytes - 1) / config_.burst_bytes;
    if (offered > 0 && offered + bursts > kBurstsPerCycle) {
      may_offer_.notify(config_.clock_period);
      return;
    }
    const sc_core::sc_time start(request_.not_before_ns, sc_core::SC_NS);
    if (start > sc_core::sc_time_stamp()) {
      may_offer_.notify(start - sc_core::sc_time_stamp());
      return;
    }
    offered += bursts;
    send();
    if (sent_ < config_.requests) request_ = next_();
  }
}

void ClosedLoopDriver::send() {
  PooledPayload& payload = pool_.acquire();
  payload.set_command(request_.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  payload.set_address(request_.address);
  const std::uint32_t bytes = bytes_of(request_);
  if (data_.size() < bytes) data_.resize(bytes);
  payload.set_data_ptr(data_.data());
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  ++sent_;
  held_back_ = &payload;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_COMPLETED)
    on_answer(payload);
  else if (status == tlm::TLM_UPDATED)
    held_back_ = nullptr;
}

void ClosedLoopDriver::on_answer(tlm::tlm_generic_payload& payload) {
  if (!payload.is_response_ok())
    SC_REPORT_ERROR("/sgs/closed_loop_driver", payload.get_response_string().c_str());
  if (held_back_ == &payload) held_back_ = nullptr;
  ++answered_;
  payload.release();
}

tlm::tlm_sync_enum ClosedLoopDriver::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                                     tlm::tlm_phase& phase, sc_core::sc_time&) {
  may_offer_.notify(sc_core::SC_ZERO_TIME);
  if (phase == tlm::END_REQ) {
    held_back_ = nullptr;
    return tlm::TLM_ACCEPTED;
  }
  on_answer(payload);
  phase = tlm::END_RESP;
  return tlm::TLM_COMPLETED;
}

StreamResult result_of(const DramStats& stats, double wall_s, std::uint64_t requests) {
  StreamResult r;
  const double ns = stats.elapsed_ns();
  const auto bytes = static_cast<double>(stats.bytes());
  const LatencyHistogram& latency = stats.read_latency_cycles.count() > 0
                                        ? stats.read_latency_cycles
                                        : stats.write_latency_cycles;
  r.gb_per_s = stats.bandwidth_gb_per_s();
  r.peak_gb_per_s = stats.peak_gb_per_s;
  r.row_hit_rate = stats.row_hit_rate();
  r.latency_mean_ns = latency.mean() * stats.clock_period_ns;
  r.latency_p50_ns = static_cast<double>(latency.percentile(0.5)) * stats.clock_period_ns;
  r.latency_p99_ns = static_cast<double>(latency.percentile(0.99)) * stats.clock_period_ns;
  r.power_mw = stats.energy.total_pj() / ns;
  r.vdd2_power_mw = stats.energy.vdd2.total_pj() / ns;
  r.pj_per_bit = stats.energy.total_pj() / (8 * bytes);
  r.band_low_mw = r.band_high_mw = r.power_mw;
  for (const auto& set : stats.energy.by_current_set_pj) {
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
