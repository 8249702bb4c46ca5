// Watches one hop between an initiator and a target for breaches of the base protocol.
#include "tlm/protocol_checker.h"

#include <fmt/format.h>

namespace sgs {

ProtocolChecker::ProtocolChecker(const sc_core::sc_module_name& name)
    : sc_module(name), from_initiator("from_initiator"), to_target("to_target") {
  from_initiator.register_nb_transport_fw(this, &ProtocolChecker::nb_transport_fw);
  from_initiator.register_b_transport(this, &ProtocolChecker::b_transport);
  from_initiator.register_transport_dbg(this, &ProtocolChecker::transport_dbg);
  to_target.register_nb_transport_bw(this, &ProtocolChecker::nb_transport_bw);
}

tlm::tlm_sync_enum ProtocolChecker::nb_transport_fw(tlm::tlm_generic_payload& payload,
                                                    tlm::tlm_phase& phase,
                                                    sc_core::sc_time& delay) {
  const tlm::tlm_phase sent = phase;
  on_forward(payload, sent);
  check_time(payload, delay);
  // The payload is read again below, when its owner may have let go of it.
  const bool counted = payload.has_mm();
  if (counted) payload.acquire();
  const tlm::tlm_sync_enum status = to_target->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_UPDATED) {
    on_backward(payload, phase);
    check_time(payload, delay);
  } else if (status == tlm::TLM_COMPLETED && sent == tlm::BEGIN_REQ) {
    on_early_completion(payload);
  } else if (status == tlm::TLM_ACCEPTED && phase != sent) {
    violation(payload, "the phase was changed by a call that returned TLM_ACCEPTED");
  }
  if (counted) payload.release();
  return status;
}

tlm::tlm_sync_enum ProtocolChecker::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                                    tlm::tlm_phase& phase,
                                                    sc_core::sc_time& delay) {
  const tlm::tlm_phase sent = phase;
  on_backward(payload, sent);
  check_time(payload, delay);
  const bool counted = payload.has_mm();
  if (counted) payload.acquire();
  const tlm::tlm_sync_enum status = from_initiator->nb_transport_bw(payload, phase, delay);
  if (status == tlm::TLM_UPDATED) {
    on_forward(payload, phase);
  } else if (status == tlm::TLM_COMPLETED) {
    if (sent == tlm::BEGIN_RESP)
      on_end_response(payload);
    else
      violation(payload, "TLM_COMPLETED returned to a call that was not BEGIN_RESP");
  }
  if (counted) payload.release();
  return status;
}

void ProtocolChecker::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  check_request(payload);
  to_target->b_transport(payload, delay);
  if (payload.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE)
    violation(payload, "b_transport returned with TLM_INCOMPLETE_RESPONSE");
  ++finished_;
}

unsigned int ProtocolChecker::transport_dbg(tlm::tlm_generic_payload& payload) {
  return to_target->transport_dbg(payload);
}

void ProtocolChecker::on_forward(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase) {
  if (phase == tlm::BEGIN_REQ)
    on_begin_request(payload);
  else if (phase == tlm::END_RESP)
    on_end_response(payload);
  else
    violation(payload, fmt::format("phase {} on the forward path", phase.get_name()));
}

void ProtocolChecker::on_begin_request(tlm::tlm_generic_payload& payload) {
  if (!payload.has_mm()) violation(payload, "a non-blocking payload without memory manager");
  if (payload.get_ref_count() < 1) violation(payload, "a non-blocking payload without reference");
  if (request_ != nullptr) violation(payload, "BEGIN_REQ before the END_REQ of the one before");
  check_request(payload);
  const bool is_new =
      in_flight_
          .insert_or_assign(&payload,
                            Known{State::kRequested, payload.get_command(), payload.get_data_ptr(),
                                  payload.get_data_length(), payload.get_streaming_width(),
                                  payload.get_byte_enable_ptr(), sc_core::SC_ZERO_TIME})
          .second;
  if (!is_new) violation(payload, "BEGIN_REQ of a transaction that is in flight");
  request_ = &payload;
}

void ProtocolChecker::on_end_response(tlm::tlm_generic_payload& payload) {
  if (response_ != &payload) {
    violation(payload, "END_RESP without BEGIN_RESP");
    return;
  }
  response_ = nullptr;
  in_flight_.erase(&payload);
  ++finished_;
}

void ProtocolChecker::on_early_completion(tlm::tlm_generic_payload& payload) {
  const auto found = in_flight_.find(&payload);
  if (found == in_flight_.end()) return;
  check_unchanged(payload, found->second);
  if (payload.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE)
    violation(payload, "TLM_COMPLETED with TLM_INCOMPLETE_RESPONSE");
  if (request_ == &payload) request_ = nullptr;
  in_flight_.erase(found);
  ++finished_;
}

void ProtocolChecker::on_backward(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase) {
  const auto found = in_flight_.find(&payload);
  if (found == in_flight_.end()) {
    violation(payload, fmt::format("{} of a transaction that is not in flight", phase.get_name()));
    return;
  }
  Known& known = found->second;
  check_unchanged(payload, known);
  if (phase == tlm::END_REQ) {
    if (known.state != State::kRequested) violation(payload, "END_REQ out of order");
    known.state = State::kAccepted;
    if (request_ == &payload) request_ = nullptr;
  } else if (phase == tlm::BEGIN_RESP) {
    if (known.state == State::kResponding) violation(payload, "a second BEGIN_RESP");
    if (response_ != nullptr && response_ != &payload)
      violation(payload, "BEGIN_RESP before the END_RESP of the one before");
    if (payload.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE)
      violation(payload, "BEGIN_RESP with TLM_INCOMPLETE_RESPONSE");
    if (request_ == &payload) request_ = nullptr;  // END_REQ is implied
    known.state = State::kResponding;
    response_ = &payload;
  } else {
    violation(payload, fmt::format("phase {} on the backward path", phase.get_name()));
  }
}

void ProtocolChecker::check_request(const tlm::tlm_generic_payload& payload) {
  if (payload.get_response_status() != tlm::TLM_INCOMPLETE_RESPONSE)
    violation(payload, "a request whose status is not TLM_INCOMPLETE_RESPONSE");
  if (payload.get_command() == tlm::TLM_IGNORE_COMMAND) return;
  if (payload.get_data_length() == 0 || payload.get_data_ptr() == nullptr)
    violation(payload, "a read or write without data");
  if (payload.get_streaming_width() == 0) violation(payload, "streaming width 0");
  if (payload.get_byte_enable_ptr() != nullptr && payload.get_byte_enable_length() == 0)
    violation(payload, "byte enables of length 0");
}

void ProtocolChecker::check_unchanged(const tlm::tlm_generic_payload& payload, const Known& known) {
  if (payload.get_command() != known.command || payload.get_data_ptr() != known.data ||
      payload.get_data_length() != known.length ||
      payload.get_streaming_width() != known.streaming_width ||
      payload.get_byte_enable_ptr() != known.byte_enable)
    violation(payload, "an attribute changed between request and response");
}

void ProtocolChecker::check_time(const tlm::tlm_generic_payload& payload,
                                 const sc_core::sc_time& delay) {
  const auto found = in_flight_.find(&payload);
  if (found == in_flight_.end()) return;
  const sc_core::sc_time at = sc_core::sc_time_stamp() + delay;
  if (at < found->second.last_time) violation(payload, "time runs backwards");
  found->second.last_time = at;
}

void ProtocolChecker::violation(const tlm::tlm_generic_payload& payload, const std::string& what) {
  violations_.push_back(fmt::format("{}: {} at {}: {} bytes at {:#x}", name(), what,
                                    sc_core::sc_time_stamp().to_string(), payload.get_data_length(),
                                    payload.get_address()));
  SC_REPORT_WARNING("/sgs/protocol_checker", violations_.back().c_str());
}

}  // namespace sgs
