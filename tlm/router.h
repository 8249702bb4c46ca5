// Address router: N initiators to targets by address range. No time of its own.
//
// Each initiator has its own path to each target. So the base protocol's exclusion rule (one
// request at a time) holds for each initiator by itself, and nobody waits behind another's request.
// Who goes first is the target's decision. Requests of one instant reach the targets at its end, in
// the order of the initiators' numbers: in which order their processes ran makes no difference.
// The initiator believes such a request to be under way, so an answer that the target returns at
// once goes back as a call; a response waits until the initiator has ended the one before.
// Addresses are passed on unchanged; a request carries its initiator's number as its requester.
#pragma once

#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <deque>
#include <systemc>
#include <tlm>
#include <vector>

#include "tlm/instant_end.h"

namespace sgs {

class Router : public sc_core::sc_module, private InstantEnd::Arbiter {
 public:
  sc_core::sc_vector<tlm_utils::passthrough_target_socket_tagged<Router>> from_initiators;

  // map() is to be called once for each of `targets`.
  Router(const sc_core::sc_module_name& name, InstantEnd& instant_end, std::uint32_t initiators,
         std::uint32_t targets = 1);

  // Sends [begin, begin + bytes) to `target`: a socket that takes several initiators, or one socket
  // for each initiator (an sc_vector). During elaboration only. std::invalid_argument: an empty or
  // overlapping range, too many targets.
  template <class TargetSocket>
  void map(std::uint64_t begin, std::uint64_t bytes, TargetSocket& target) {
    const std::size_t first = add_range(begin, bytes);
    for (std::size_t i = 0; i < from_initiators.size(); ++i) to_targets_[first + i].bind(target);
  }
  template <class Socket>
  void map(std::uint64_t begin, std::uint64_t bytes, sc_core::sc_vector<Socket>& targets) {
    const std::size_t first = add_range(begin, bytes);
    for (std::size_t i = 0; i < from_initiators.size(); ++i) {
      to_targets_[first + i].bind(targets[i]);
    }
  }

 private:
  using OutSocket = tlm_utils::simple_initiator_socket_tagged<Router>;
  struct Range {
    std::uint64_t begin;
    std::uint64_t last;
    std::size_t first_socket;  // socket of initiator 0; the others follow
  };
  // A response on its way back.
  struct Response {
    tlm::tlm_generic_payload* payload = nullptr;  // null: none
    bool target_ended = false;                    // by TLM_COMPLETED: it waits for no END_RESP
    sc_core::sc_time due;                         // when it begins
  };
  struct Path {
    tlm::tlm_generic_payload* held = nullptr;              // request of this instant
    const tlm::tlm_generic_payload* requesting = nullptr;  // passed on, END_REQ not seen
    Response open;                                         // passed back, END_RESP not seen
    std::deque<Response> waiting;                          // for the end of that one
    bool may_respond() const { return open.payload == nullptr && waiting.empty(); }
  };

  std::size_t add_range(std::uint64_t begin, std::uint64_t bytes);
  // Null when [address, address + length) does not lie in one range.
  OutSocket* find(int initiator, const tlm::tlm_generic_payload& payload);

  void decide() override;
  void pass_on(int initiator, tlm::tlm_generic_payload& payload);
  void respond(int initiator, const Response& response);
  tlm::tlm_sync_enum send_response(int initiator, const Response& response, tlm::tlm_phase& phase,
                                   sc_core::sc_time& delay);
  tlm::tlm_sync_enum end_response(int initiator, tlm::tlm_generic_payload& payload,
                                  tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void make_wait(int initiator, const Response& response);
  void close_response(Path& path);
  tlm::tlm_sync_enum nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  tlm::tlm_sync_enum nb_transport_bw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(int initiator, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned int transport_dbg(int initiator, tlm::tlm_generic_payload& payload);

  InstantEnd& instant_end_;
  sc_core::sc_vector<OutSocket> to_targets_;
  std::vector<Path> paths_;  // [initiator]
  std::vector<Range> ranges_;
};

}  // namespace sgs
