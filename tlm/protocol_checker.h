// Watches one hop between an initiator and a target and reports what breaks the base protocol.
// Passes everything on unchanged; no time of its own. Meant for tests.
#pragma once

#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>
#include <unordered_map>
#include <vector>

namespace sgs {

// Rules (IEEE 1666-2011, 15.2 and 14.7-14.17): phases in order and on their own path; one request
// and one response at a time (exclusion); attributes fixed from request to response; a memory
// manager and a reference on every non-blocking payload; status incomplete going out, something
// else coming back; bytes where a length is given; times of a transaction that do not run
// backwards. A request answered by TLM_COMPLETED has no response phase, so exclusion does not apply
// to it.
class ProtocolChecker : public sc_core::sc_module {
 public:
  tlm_utils::passthrough_target_socket<ProtocolChecker> from_initiator;
  tlm_utils::simple_initiator_socket<ProtocolChecker> to_target;

  explicit ProtocolChecker(const sc_core::sc_module_name& name);

  // Each is also an SC_REPORT_WARNING when it happens.
  const std::vector<std::string>& violations() const { return violations_; }
  // Transactions begun and not yet answered.
  std::size_t in_flight() const { return in_flight_.size(); }
  std::uint64_t finished() const { return finished_; }

 private:
  enum class State { kRequested, kAccepted, kResponding };
  struct Known {
    State state;
    tlm::tlm_command command;
    const std::uint8_t* data;
    unsigned int length;
    unsigned int streaming_width;
    const std::uint8_t* byte_enable;
    sc_core::sc_time last_time;
  };

  tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);
  void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned int transport_dbg(tlm::tlm_generic_payload& payload);

  void on_forward(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase);
  void on_backward(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase);
  void on_begin_request(tlm::tlm_generic_payload& payload);
  void on_end_response(tlm::tlm_generic_payload& payload);
  void check_request(const tlm::tlm_generic_payload& payload);
  void check_unchanged(const tlm::tlm_generic_payload& payload, const Known& known);
  void check_time(const tlm::tlm_generic_payload& payload, const sc_core::sc_time& delay);
  void on_early_completion(tlm::tlm_generic_payload& payload);
  void violation(const tlm::tlm_generic_payload& payload, const std::string& what);

  std::unordered_map<const tlm::tlm_generic_payload*, Known> in_flight_;
  const tlm::tlm_generic_payload* request_ = nullptr;   // BEGIN_REQ seen, END_REQ not
  const tlm::tlm_generic_payload* response_ = nullptr;  // BEGIN_RESP seen, END_RESP not
  std::uint64_t finished_ = 0;
  std::vector<std::string> violations_;
};

}  // namespace sgs
