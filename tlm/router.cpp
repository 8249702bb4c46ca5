// Address router: N initiators to targets by address range.
#include "tlm/router.h"

#include <fmt/format.h>

#include <stdexcept>

#include "tlm/memory_extension.h"

namespace sgs {
namespace {

// True if the call that passed a response back has ended it.
bool ends_response(tlm::tlm_sync_enum status, const tlm::tlm_phase& phase) {
  return status == tlm::TLM_COMPLETED || (status == tlm::TLM_UPDATED && phase == tlm::END_RESP);
}

}  // namespace

Router::Router(const sc_core::sc_module_name& name, InstantEnd& instant_end,
               std::uint32_t initiators, std::uint32_t targets)
    : sc_module(name),
      from_initiators("from_initiators", initiators),
      instant_end_(instant_end),
      to_targets_("to_targets", std::size_t{initiators} * targets),
      paths_(initiators) {
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
  if (phase == tlm::END_RESP) return end_response(initiator, payload, phase, delay);
  OutSocket* out = find(initiator, payload);
  if (out == nullptr) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return tlm::TLM_COMPLETED;
  }
  if (auto* memory = payload.get_extension<MemoryExtension>()) {
    memory->requester = static_cast<std::uint8_t>(initiator);
  }
  if (phase != tlm::BEGIN_REQ) return (*out)->nb_transport_fw(payload, phase, delay);
  Path& path = paths_[static_cast<std::size_t>(initiator)];
  path.requesting = &payload;
  if (delay == sc_core::SC_ZERO_TIME) {
    payload.acquire();
    path.held = &payload;
    instant_end_.ask_for(*this);
    return tlm::TLM_ACCEPTED;
  }
  // A request that says when it arrives has its order already.
  const sc_core::sc_time arrives_in = delay;
  const tlm::tlm_sync_enum status = (*out)->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_ACCEPTED) return status;
  path.requesting = nullptr;
  if (status != tlm::TLM_UPDATED || phase != tlm::BEGIN_RESP) return status;
  const Response response{&payload, false, sc_core::sc_time_stamp() + delay};
  if (path.may_respond()) {
    path.open = response;
    return status;
  }
  make_wait(initiator, response);
  phase = tlm::END_REQ;
  delay = arrives_in;
  return status;
}

// Passes on the responses and requests that wait, in the order of the initiators.
void Router::decide() {
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    Path& path = paths_[i];
    if (path.open.payload == nullptr && !path.waiting.empty()) {
      const Response response = path.waiting.front();
      path.waiting.pop_front();
      respond(static_cast<int>(i), response);
      response.payload->release();
    }
    if (path.held != nullptr) {
      tlm::tlm_generic_payload& payload = *path.held;
      path.held = nullptr;
      pass_on(static_cast<int>(i), payload);
      payload.release();
    }
  }
}

void Router::pass_on(int initiator, tlm::tlm_generic_payload& payload) {
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  const tlm::tlm_sync_enum status =
      (*find(initiator, payload))->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_ACCEPTED) return;
  if (status == tlm::TLM_UPDATED && phase == tlm::END_REQ) {
    nb_transport_bw(initiator, payload, phase, delay);
    return;
  }
  const Response response{&payload, status == tlm::TLM_COMPLETED, sc_core::sc_time_stamp() + delay};
  if (paths_[static_cast<std::size_t>(initiator)].may_respond()) {
    respond(initiator, response);
  } else {
    make_wait(initiator, response);
  }
}

// Keeps a response until the one before has ended. Its request ends nevertheless.
void Router::make_wait(int initiator, const Response& response) {
  Path& path = paths_[static_cast<std::size_t>(initiator)];
  response.payload->acquire();
  path.waiting.push_back(response);
  if (path.requesting != response.payload) return;
  tlm::tlm_phase phase = tlm::END_REQ;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  nb_transport_bw(initiator, *response.payload, phase, delay);
}

// Sends a response that the target believes to be under way.
void Router::respond(int initiator, const Response& response) {
  const sc_core::sc_time now = sc_core::sc_time_stamp();
  tlm::tlm_phase phase = tlm::BEGIN_RESP;
  sc_core::sc_time delay =
      response.due > now ? sc_core::sc_time(response.due - now) : sc_core::SC_ZERO_TIME;
  const tlm::tlm_sync_enum status = send_response(initiator, response, phase, delay);
  if (!ends_response(status, phase) || response.target_ended) return;
  phase = tlm::END_RESP;
  (*find(initiator, *response.payload))->nb_transport_fw(*response.payload, phase, delay);
}

tlm::tlm_sync_enum Router::send_response(int initiator, const Response& response,
                                         tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  Path& path = paths_[static_cast<std::size_t>(initiator)];
  if (path.requesting == response.payload) path.requesting = nullptr;
  path.open = response;
  const tlm::tlm_sync_enum status =
      from_initiators[static_cast<std::size_t>(initiator)]->nb_transport_bw(*response.payload,
                                                                            phase, delay);
  if (ends_response(status, phase)) close_response(path);
  return status;
}

tlm::tlm_sync_enum Router::end_response(int initiator, tlm::tlm_generic_payload& payload,
                                        tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  Path& path = paths_[static_cast<std::size_t>(initiator)];
  const bool target_ended = path.open.payload == &payload && path.open.target_ended;
  if (path.open.payload == &payload) close_response(path);
  OutSocket* out = find(initiator, payload);
  if (target_ended || out == nullptr) return tlm::TLM_COMPLETED;
  return (*out)->nb_transport_fw(payload, phase, delay);
}

void Router::close_response(Path& path) {
  path.open = {};
  if (!path.waiting.empty()) instant_end_.ask_for(*this);
}

tlm::tlm_sync_enum Router::nb_transport_bw(int initiator, tlm::tlm_generic_payload& payload,
                                           tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  Path& path = paths_[static_cast<std::size_t>(initiator)];
  if (phase != tlm::BEGIN_RESP) {
    if (path.requesting == &payload) path.requesting = nullptr;
    return from_initiators[static_cast<std::size_t>(initiator)]->nb_transport_bw(payload, phase,
                                                                                 delay);
  }
  const Response response{&payload, false, sc_core::sc_time_stamp() + delay};
  if (path.may_respond()) return send_response(initiator, response, phase, delay);
  make_wait(initiator, response);
  return tlm::TLM_ACCEPTED;
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
