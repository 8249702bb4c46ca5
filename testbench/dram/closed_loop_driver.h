// Drives a memory as hard as a window of outstanding requests allows.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <functional>
#include <systemc>
#include <tlm>
#include <vector>

#include "testbench/dram/request_generator.h"
#include "tlm/payload_pool.h"

namespace sgs {

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

}  // namespace sgs
