// Address router: N initiators to targets by address range. No time of its own.
//
// Each initiator has its own path to each target, so that the base protocol's exclusion rule (one
// request at a time) holds for each initiator by itself and nobody waits behind another's request;
// who goes first is the target's decision. Addresses are passed on unchanged.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

namespace sgs {

class Router : public sc_core::sc_module {
 public:
  sc_core::sc_vector<tlm_utils::passthrough_target_socket_tagged<Router>> from_initiators;

  // map() is to be called once for each of `targets`.
  Router(const sc_core::sc_module_name& name, std::uint32_t initiators, std::uint32_t targets = 1);

  // Sends [begin, begin + bytes) to `target`, a socket that takes several initiators (a
  // multi_passthrough_target_socket): one is bound for each of the router's initiators. During
  // elaboration only. std::invalid_argument: an empty or overlapping range, too many targets.
  template <class TargetSocket>
  void map(std::uint64_t begin, std::uint64_t bytes, TargetSocket& target) {
    const std::size_t first = add_range(begin, bytes);
    for (std::size_t i = 0; i < from_initiators.size(); ++i) to_targets_[first + i].bind(target);
  }

 private:
  using OutSocket = tlm_utils::simple_initiator_socket_tagged<Router>;
  struct Range {
    std::uint64_t begin;
    std::uint64_t last;
    std::size_t first_socket;  // that of initiator 0; the others follow
  };

  std::size_t add_range(std::uint64_t begin, std::uint64_t bytes);
  // Null when [address, address + length) does not lie in one range.
  OutSocket* find(int initiator, const tlm::tlm_generic_payload& payload);

  tlm::tlm_sync_enum nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  tlm::tlm_sync_enum nb_transport_bw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(int initiator, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned int transport_dbg(int initiator, tlm::tlm_generic_payload& payload);

  sc_core::sc_vector<OutSocket> to_targets_;
  std::vector<Range> ranges_;
};

}  // namespace sgs
