// Requests that wait for their time.
#include "testbench/units/fixed_latency_memory.h"

#include <cstring>

namespace sgs::tb {

FixedLatencyMemory::FixedLatencyMemory(const sc_core::sc_module_name& name, std::size_t bytes,
                                       const sc_core::sc_time& read_latency,
                                       const sc_core::sc_time& write_latency)
    : sc_module(name),
      socket("socket"),
      read_latency_(read_latency),
      write_latency_(write_latency),
      bytes_(bytes) {
  socket.register_nb_transport_fw(this, &FixedLatencyMemory::nb_transport_fw);
  socket.register_transport_dbg(this, &FixedLatencyMemory::transport_dbg);
  SC_METHOD(on_due);
  sensitive << due_;
  dont_initialize();
}

bool FixedLatencyMemory::holds(const ::tlm::tlm_generic_payload& payload) const {
  return payload.get_address() <= bytes_.size() &&
         payload.get_data_length() <= bytes_.size() - payload.get_address();
}

::tlm::tlm_sync_enum FixedLatencyMemory::nb_transport_fw(int initiator,
                                                         ::tlm::tlm_generic_payload& payload,
                                                         ::tlm::tlm_phase& phase,
                                                         sc_core::sc_time& delay) {
  if (phase != ::tlm::BEGIN_REQ || delay != sc_core::SC_ZERO_TIME) {
    SC_REPORT_ERROR("/sgs/fixed_latency_memory", "only requests, each when it is made");
    return ::tlm::TLM_ACCEPTED;
  }
  if (!holds(payload)) {
    payload.set_response_status(::tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return ::tlm::TLM_COMPLETED;
  }
  payload.acquire();
  Access access{initiator, &payload, {}};
  if (payload.is_read()) {
    const std::byte* here = at(payload.get_address());
    access.read.assign(here, here + payload.get_data_length());
  }
  const sc_core::sc_time& latency = payload.is_read() ? read_latency_ : write_latency_;
  due_.notify(latency);  // has no effect where an earlier notification is pending
  accesses_.emplace(sc_core::sc_time_stamp() + latency, std::move(access));
  phase = ::tlm::END_REQ;
  return ::tlm::TLM_UPDATED;
}

void FixedLatencyMemory::on_due() {
  const sc_core::sc_time& now = sc_core::sc_time_stamp();
  while (!accesses_.empty() && accesses_.begin()->first <= now) {
    Access access = std::move(accesses_.begin()->second);
    accesses_.erase(accesses_.begin());
    answer(access);
  }
  if (!accesses_.empty()) due_.notify(accesses_.begin()->first - now);
}

void FixedLatencyMemory::answer(Access& access) {
  ::tlm::tlm_generic_payload& payload = *access.payload;
  if (payload.is_read()) {
    std::memcpy(payload.get_data_ptr(), access.read.data(), access.read.size());
  } else {
    std::memcpy(at(payload.get_address()), payload.get_data_ptr(), payload.get_data_length());
  }
  payload.set_response_status(::tlm::TLM_OK_RESPONSE);
  ::tlm::tlm_phase phase = ::tlm::BEGIN_RESP;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  if (socket[access.initiator]->nb_transport_bw(payload, phase, delay) != ::tlm::TLM_COMPLETED) {
    SC_REPORT_ERROR("/sgs/fixed_latency_memory", "an initiator that does not end its transaction");
  }
  payload.release();
}

unsigned int FixedLatencyMemory::transport_dbg(int, ::tlm::tlm_generic_payload& payload) {
  if (!holds(payload) || payload.get_data_length() == 0) return 0;
  std::byte* here = at(payload.get_address());
  if (payload.is_read()) {
    std::memcpy(payload.get_data_ptr(), here, payload.get_data_length());
  } else {
    std::memcpy(here, payload.get_data_ptr(), payload.get_data_length());
  }
  return payload.get_data_length();
}

}  // namespace sgs::tb
