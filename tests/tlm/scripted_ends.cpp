// The ways of using the base protocol, spelled out.
#include "tests/tlm/scripted_ends.h"

namespace sgs::test {

using sc_core::SC_NS;
using sc_core::sc_time;
using sc_core::sc_time_stamp;
using sc_core::SC_ZERO_TIME;

ScriptedInitiator::ScriptedInitiator(const sc_core::sc_module_name& name, const Script& script)
    : sc_module(name), socket("socket"), script_(script) {
  socket.register_nb_transport_bw(this, &ScriptedInitiator::nb_transport_bw);
  SC_THREAD(run);
  SC_THREAD(ends);
}

void ScriptedInitiator::run() {
  for (int k = 0; k < script_.requests; ++k) {
    PooledPayload& payload = pool_.acquire();
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(static_cast<std::uint64_t>(k) * 64);
    payload.set_data_ptr(payload.buffer(1));
    *payload.get_data_ptr() = 0xee;
    payload.set_data_length(1);
    payload.set_streaming_width(1);
    requesting_ = &payload;
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_time delay = script_.request_delay;
    const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
    if (status == tlm::TLM_COMPLETED) {
      ended(payload, delay);
      answered(payload, delay);
      payload.release();
    } else if (status == tlm::TLM_UPDATED) {
      ended(payload, delay);
      if (phase == tlm::BEGIN_RESP) {
        answered(payload, delay);
        wait(delay);
        end_response(payload);
      }
    }
    while (requesting_ != nullptr) wait(may_request_);
    if (ended_at_ > sc_time_stamp()) wait(ended_at_ - sc_time_stamp());
  }
}

void ScriptedInitiator::ended(const tlm::tlm_generic_payload& payload, const sc_time& delay) {
  if (requesting_ != &payload) return;
  ended_at_ = sc_time_stamp() + delay;
  request_ends.push_back(ended_at_);
  requesting_ = nullptr;
  may_request_.notify(SC_ZERO_TIME);
}

void ScriptedInitiator::answered(const tlm::tlm_generic_payload& payload, const sc_time& delay) {
  answers.push_back(sc_time_stamp() + delay);
  right +=
      payload.is_response_ok() && *payload.get_data_ptr() == payload.get_address() / 64 ? 1 : 0;
}

tlm::tlm_sync_enum ScriptedInitiator::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                                      tlm::tlm_phase& phase, sc_time& delay) {
  ended(payload, delay);
  if (phase == tlm::END_REQ) return tlm::TLM_ACCEPTED;
  answered(payload, delay);
  if (script_.ends == Ends::kByCall) {
    constexpr double kHeldNs = 35;
    to_end_ = &payload;
    end_at_ = sc_time_stamp() + delay + sc_time(kHeldNs, SC_NS);
    may_end_.notify(end_at_ - sc_time_stamp());
    return tlm::TLM_ACCEPTED;
  }
  payload.release();
  if (script_.ends == Ends::kByCompletion) return tlm::TLM_COMPLETED;
  phase = tlm::END_RESP;
  return tlm::TLM_UPDATED;
}

void ScriptedInitiator::ends() {
  while (true) {
    while (to_end_ == nullptr || end_at_ > sc_time_stamp()) wait(may_end_);
    tlm::tlm_generic_payload& payload = *to_end_;
    to_end_ = nullptr;
    end_response(payload);
  }
}

void ScriptedInitiator::end_response(tlm::tlm_generic_payload& payload) {
  tlm::tlm_phase phase = tlm::END_RESP;
  sc_time delay = SC_ZERO_TIME;
  socket->nb_transport_fw(payload, phase, delay);
  payload.release();
}

ScriptedTarget::ScriptedTarget(const sc_core::sc_module_name& name, Answers answers)
    : sc_module(name), socket("socket"), answers_(answers) {
  socket.register_nb_transport_fw(this, &ScriptedTarget::nb_transport_fw);
  SC_THREAD(run);
}

tlm::tlm_sync_enum ScriptedTarget::nb_transport_fw(tlm::tlm_generic_payload& payload,
                                                   tlm::tlm_phase& phase, sc_time& delay) {
  if (phase == tlm::END_RESP) {
    open_ = nullptr;
    ended_.notify(SC_ZERO_TIME);
    payload.release();
    return tlm::TLM_COMPLETED;
  }
  *payload.get_data_ptr() = static_cast<std::uint8_t>(payload.get_address() / 64);
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  constexpr int kWays = static_cast<int>(Answers::kMixed);
  const int turn = requests_++;
  return answer(answers_ == Answers::kMixed ? static_cast<Answers>(turn % kWays) : answers_,
                payload, phase, delay);
}

tlm::tlm_sync_enum ScriptedTarget::answer(Answers how, tlm::tlm_generic_payload& payload,
                                          tlm::tlm_phase& phase, sc_time& delay) {
  if (how == Answers::kCompletedLater) delay += sc_time(30, SC_NS);
  if (how == Answers::kCompleted || how == Answers::kCompletedLater) return tlm::TLM_COMPLETED;
  payload.acquire();
  const bool response = how == Answers::kResponse || how == Answers::kResponseLater;
  if (response && open_ == nullptr) {
    if (how == Answers::kResponseLater) delay += sc_time(20, SC_NS);
    open_ = &payload;
    phase = tlm::BEGIN_RESP;
    return tlm::TLM_UPDATED;
  }
  if (response || how == Answers::kEndOfRequest) {
    call_later(40, delay, {&payload, tlm::BEGIN_RESP, SC_ZERO_TIME});
    phase = tlm::END_REQ;
    return tlm::TLM_UPDATED;
  }
  if (how == Answers::kCalls) {
    call_later(10, delay, {&payload, tlm::END_REQ, SC_ZERO_TIME});
    call_later(50, delay, {&payload, tlm::BEGIN_RESP, SC_ZERO_TIME});
  } else if (how == Answers::kResponseCall) {
    call_later(25, delay, {&payload, tlm::BEGIN_RESP, SC_ZERO_TIME});
  } else {
    call_later(5, delay, {&payload, tlm::END_REQ, sc_time(5, SC_NS)});
    call_later(15, delay, {&payload, tlm::BEGIN_RESP, sc_time(30, SC_NS)});
  }
  return tlm::TLM_ACCEPTED;
}

void ScriptedTarget::call_later(double ns, const sc_time& delay, const Call& call) {
  calls_.emplace(sc_time_stamp() + delay + sc_time(ns, SC_NS), call);
  changed_.notify(SC_ZERO_TIME);
}

void ScriptedTarget::run() {
  while (true) {
    if (calls_.empty()) {
      wait(changed_);
    } else if (calls_.begin()->first > sc_time_stamp()) {
      wait(calls_.begin()->first - sc_time_stamp(), changed_);
    } else {
      const Call next = calls_.begin()->second;
      calls_.erase(calls_.begin());
      call(next);
    }
  }
}

void ScriptedTarget::call(const Call& call) {
  tlm::tlm_phase phase = call.phase;
  sc_time delay = call.delay;
  const bool response = phase == tlm::BEGIN_RESP;
  while (response && open_ != nullptr) wait(ended_);
  if (response) open_ = call.payload;
  const tlm::tlm_sync_enum status = socket->nb_transport_bw(*call.payload, phase, delay);
  if (!response || status == tlm::TLM_ACCEPTED) return;
  open_ = nullptr;
  ended_.notify(SC_ZERO_TIME);
  call.payload->release();
}

}  // namespace sgs::test
