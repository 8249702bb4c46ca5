// A memory with one socket for all initiators that completes every request in the call that makes
// it, with its latency as an annotation.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>

#include <systemc>

#include "tests/testbench/other_memory/payload_bytes.h"

namespace sgs::test {

class PromptMemory : public sc_core::sc_module {
 public:
  tlm_utils::multi_passthrough_target_socket<PromptMemory> socket{"socket"};

  PromptMemory(const sc_core::sc_module_name& name, std::size_t capacity,
               const sc_core::sc_time& latency)
      : sc_module(name), bytes(capacity), latency_(latency) {
    socket.register_nb_transport_fw(this, &PromptMemory::nb_transport_fw);
    socket.register_transport_dbg(this, &PromptMemory::transport_dbg);
  }

  PayloadBytes bytes;

 private:
  tlm::tlm_sync_enum nb_transport_fw(int, tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay) {
    if (phase != tlm::BEGIN_REQ) {
      SC_REPORT_ERROR("/sgs/test/prompt_memory", "a phase behind the end of its transaction");
    }
    bytes.serve(payload);
    delay += latency_;
    return tlm::TLM_COMPLETED;
  }
  unsigned int transport_dbg(int, tlm::tlm_generic_payload& payload) {
    return bytes.serve(payload);
  }

  const sc_core::sc_time latency_;
};

}  // namespace sgs::test
