// A memory that knows b_transport alone, a socket for each initiator: TLM-2.0's own simple socket
// turns the four phases of the machine's ports into it, one request after the other.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <systemc>

#include "tests/testbench/other_memory/payload_bytes.h"

namespace sgs::test {

class BlockingMemory : public sc_core::sc_module {
 public:
  sc_core::sc_vector<tlm_utils::simple_target_socket_tagged<BlockingMemory>> sockets;

  BlockingMemory(const sc_core::sc_module_name& name, std::size_t initiators, std::size_t capacity,
                 const sc_core::sc_time& latency)
      : sc_module(name), sockets("sockets", initiators), bytes(capacity), latency_(latency) {
    for (auto& socket : sockets) {
      socket.register_b_transport(this, &BlockingMemory::b_transport, 0);
      socket.register_transport_dbg(this, &BlockingMemory::transport_dbg, 0);
    }
  }

  PayloadBytes bytes;

 private:
  void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    bytes.serve(payload);
    delay += latency_;
  }
  unsigned int transport_dbg(int, tlm::tlm_generic_payload& payload) {
    return bytes.serve(payload);
  }

  const sc_core::sc_time latency_;
};

}  // namespace sgs::test
