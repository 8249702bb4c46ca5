// Address router: N initiators to targets by address range.
#include "tlm/router.h"

#include <fmt/format.h>

#include <stdexcept>

namespace sgs {

Router::Router(const sc_core::sc_module_name& name, std::uint32_t initiators, std::uint32_t targets)
    : sc_module(name),
      from_initiators("from_initiators", initiators),
      to_targets_("to_targets", std::size_t{initiators} * targets) {
  for (std::uint32_t i = 0; i < initiators; ++i) {
    const int id = static_cast<int>(i);
    from_initiators[i].register_nb_transport_fw(this, &Router::nb_transport_fw, id);
    from_initiators[i].register_b_transport(this, &Router::b_transport, id);
    from_initiators[i].register_transport_dbg(this, &Router::transport_dbg, id);
  }
  for (std::size_t i = 0; i < to_targets_.size(); ++i)
    to_targets_[i].register_nb_transport_bw(this, &Router::nb_transport_bw,
                                            static_cast<int>(i % initiators));
}

std::size_t Router::add_range(std::uint64_t begin, std::uint64_t bytes) {
  const std::uint64_t last = begin + bytes - 1;
  const std::size_t first_socket = ranges_.size() * from_initiators.size();
  if (bytes == 0 || last < begin)
    throw std::invalid_argument(
        fmt::format("{}: range of {} bytes at {:#x}", name(), bytes, begin));
  if (first_socket == to_targets_.size())
    throw std::invalid_argument(
        fmt::format("{}: more targets than the {} stated", name(), ranges_.size()));
  for (const Range& other : ranges_)
    if (begin <= other.last && other.begin <= last)
      throw std::invalid_argument(fmt::format("{}: range [{:#x}, {:#x}] overlaps [{:#x}, {:#x}]",
                                              name(), begin, last, other.begin, other.last));
  ranges_.push_back({begin, last, first_socket});
  return first_socket;
}

Router::OutSocket* Router::find(int initiator, const tlm::tlm_generic_payload& payload) {
  const std::uint64_t begin = payload.get_address();
  const std::uint64_t length = payload.get_data_length();
  const std::uint64_t last = begin + (length > 0 ? length - 1 : 0);
  for (const Range& range : ranges_)
    if (begin >= range.begin && last <= range.last && last >= begin)
      return &to_targets_[range.first_socket + static_cast<std::size_t>(initiator)];
  return nullptr;
}

tlm::tlm_sync_enum Router::nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                           tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  OutSocket* out = find(initiator, payload);
  if (out == nullptr) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return tlm::TLM_COMPLETED;
  }
  return (*out)->nb_transport_fw(payload, phase, delay);
}

tlm::tlm_sync_enum Router::nb_transport_bw(int initiator, tlm::tlm_generic_payload& payload,
                                           tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  return from_initiators[static_cast<std::size_t>(initiator)]->nb_transport_bw(payload, phase,
                                                                               delay);
}

void Router::b_transport(int initiator, tlm::tlm_generic_payload& payload,
                         sc_core::sc_time& delay) {
  OutSocket* out = find(initiator, payload);
  if (out == nullptr) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return;
  }
  (*out)->b_transport(payload, delay);
}

unsigned int Router::transport_dbg(int initiator, tlm::tlm_generic_payload& payload) {
  OutSocket* out = find(initiator, payload);
  if (out == nullptr) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return 0;
  }
  return (*out)->transport_dbg(payload);
}

}  // namespace sgs
