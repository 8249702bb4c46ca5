// An initiator whose thread is the test, and which notes when phases come.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <functional>
#include <systemc>
#include <tlm>
#include <utility>
#include <vector>

#include "tlm/payload_pool.h"

namespace sgs::test {

class Initiator : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<Initiator> socket;
  SC_HAS_PROCESS(Initiator);
  Initiator(const sc_core::sc_module_name& name, std::function<void(Initiator&)> body)
      : sc_module(name), socket("socket"), body_(std::move(body)) {
    socket.register_nb_transport_bw(this, &Initiator::nb_transport_bw);
    SC_THREAD(run);
  }

  PooledPayload& make(tlm::tlm_command command, std::uint64_t address, std::uint32_t bytes) {
    PooledPayload& p = pool.acquire();
    p.set_command(command);
    p.set_address(address);
    p.set_data_ptr(p.buffer(bytes));
    p.set_data_length(bytes);
    p.set_streaming_width(bytes);
    return p;
  }
  tlm::tlm_sync_enum begin(PooledPayload& p, sc_core::sc_time delay = sc_core::SC_ZERO_TIME) {
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    return socket->nb_transport_fw(p, phase, delay);
  }
  tlm::tlm_response_status blocking(PooledPayload& p, sc_core::sc_time& delay) {
    socket->b_transport(p, delay);
    return p.get_response_status();
  }

  PayloadPool pool;
  std::vector<sc_core::sc_time> end_requests;
  std::vector<sc_core::sc_time> answers;
  bool finished = false;

 private:
  void run() {
    body_(*this);
    finished = true;
  }
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& p, tlm::tlm_phase& phase,
                                     sc_core::sc_time&) {
    if (phase == tlm::END_REQ) {
      end_requests.push_back(sc_core::sc_time_stamp());
      return tlm::TLM_ACCEPTED;
    }
    answers.push_back(sc_core::sc_time_stamp());
    phase = tlm::END_RESP;
    p.release();
    return tlm::TLM_COMPLETED;
  }
  std::function<void(Initiator&)> body_;
};

}  // namespace sgs::test
