// A memory that answers every blocking access after the same time: what a unit does can then be
// computed to the cycle.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <cstddef>
#include <cstring>
#include <systemc>
#include <tlm>
#include <vector>

namespace sgs::tb {

class FixedLatencyMemory : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<FixedLatencyMemory> socket;

  FixedLatencyMemory(const sc_core::sc_module_name& name, std::size_t bytes,
                     const sc_core::sc_time& latency)
      : sc_module(name), socket("socket"), latency_(latency), bytes_(bytes) {
    socket.register_b_transport(this, &FixedLatencyMemory::b_transport);
  }

  std::byte* at(std::size_t address) { return bytes_.data() + address; }

 private:
  void b_transport(::tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    if (payload.get_address() + payload.get_data_length() > bytes_.size()) {
      payload.set_response_status(::tlm::TLM_ADDRESS_ERROR_RESPONSE);
      return;
    }
    std::byte* here = at(payload.get_address());
    if (payload.is_read()) {
      std::memcpy(payload.get_data_ptr(), here, payload.get_data_length());
    } else {
      std::memcpy(here, payload.get_data_ptr(), payload.get_data_length());
    }
    payload.set_response_status(::tlm::TLM_OK_RESPONSE);
    delay += latency_;
  }

  const sc_core::sc_time latency_;
  std::vector<std::byte> bytes_;
};

}  // namespace sgs::tb
