// Drives a memory as hard as a window of outstanding requests allows.
#include "testbench/dram/closed_loop_driver.h"

#include <algorithm>

namespace sgs {

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

}  // namespace sgs
