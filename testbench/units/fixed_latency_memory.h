// A memory that takes every request at once and answers every read after the same time, and every
// write: what a unit does can then be computed to the cycle.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <systemc>
#include <tlm>
#include <vector>

namespace sgs::tb {

// Bytes move late: a write is in the memory, and what was read is in the initiator's buffer, when
// it is answered and no sooner; a read gives what was in the memory when it came. Who does not wait
// for an answer gets old bytes.
class FixedLatencyMemory : public sc_core::sc_module {
 public:
  tlm_utils::multi_passthrough_target_socket<FixedLatencyMemory> socket;

  SC_HAS_PROCESS(FixedLatencyMemory);
  FixedLatencyMemory(const sc_core::sc_module_name& name, std::size_t bytes,
                     const sc_core::sc_time& read_latency, const sc_core::sc_time& write_latency);

  std::byte* at(std::size_t address) { return bytes_.data() + address; }
  bool idle() const { return accesses_.empty(); }

 private:
  struct Access {
    int initiator;
    ::tlm::tlm_generic_payload* payload;
    std::vector<std::byte> read;
  };

  ::tlm::tlm_sync_enum nb_transport_fw(int initiator, ::tlm::tlm_generic_payload& payload,
                                       ::tlm::tlm_phase& phase, sc_core::sc_time& delay);
  unsigned int transport_dbg(int initiator, ::tlm::tlm_generic_payload& payload);
  bool holds(const ::tlm::tlm_generic_payload& payload) const;
  void on_due();  // method
  void answer(Access& access);

  const sc_core::sc_time read_latency_, write_latency_;
  std::vector<std::byte> bytes_;
  std::multimap<sc_core::sc_time, Access> accesses_;  // by the time of the answer
  sc_core::sc_event due_;
};

}  // namespace sgs::tb
