// An initiator that does everything the base protocol allows, at random.
#include "testbench/dram/random_initiator.h"

#include <algorithm>

namespace sgs {

RandomInitiator::RandomInitiator(const sc_core::sc_module_name& name, const Config& config)
    : sc_module(name),
      socket("socket"),
      config_(config),
      random_(config.seed),
      mirror_(config.bytes),
      slots_(kWindow) {
  socket.register_nb_transport_bw(this, &RandomInitiator::nb_transport_bw);
  SC_THREAD(run);
  SC_THREAD(hold_up_answers);
}

bool RandomInitiator::all_idle() const {
  return std::all_of(slots_.begin(), slots_.end(),
                     [](const Slot& slot) { return slot.payload == nullptr; });
}

void RandomInitiator::run() {
  for (std::uint64_t sent = 0; sent < config_.transactions;) {
    const auto free = std::find_if(slots_.begin(), slots_.end(),
                                   [](const Slot& slot) { return slot.payload == nullptr; });
    if (free == slots_.end() || requesting_ != nullptr) {
      wait(changed_);
      continue;
    }
    if (below(4) == 0) wait(sc_core::sc_time(below(200), sc_core::SC_NS));
    start(*free);
    ++sent;
  }
  while (!all_idle()) wait(changed_);
  finished_ = true;
}

void RandomInitiator::start(Slot& slot) {
  const std::uint32_t length = 1 + below(below(8) == 0 ? 3000 : 100);
  const std::uint32_t offset = below(config_.bytes - length);
  const bool write = below(2) == 0;
  slot.data.assign(length, 0xee);
  slot.enables.clear();
  if (below(4) == 0)
    for (std::uint32_t i = 0; i < 1 + length / 3; ++i)
      slot.enables.push_back(below(2) == 0 ? TLM_BYTE_ENABLED : TLM_BYTE_DISABLED);
  slot.expected = slot.data;
  for (std::uint32_t i = 0; i < length; ++i) {
    if (write) slot.data[i] = static_cast<std::uint8_t>(random_());
    const bool enabled =
        slot.enables.empty() || slot.enables[i % slot.enables.size()] == TLM_BYTE_ENABLED;
    if (!enabled) continue;
    if (write)
      mirror_[offset + i] = slot.data[i];
    else
      slot.expected[i] = mirror_[offset + i];
  }
  if (write) slot.expected = slot.data;

  PooledPayload& payload = pool_.acquire();
  slot.payload = &payload;
  payload.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  payload.set_address(config_.begin + offset);
  payload.set_data_ptr(slot.data.data());
  payload.set_data_length(length);
  payload.set_streaming_width(length);
  if (!slot.enables.empty()) {
    payload.set_byte_enable_ptr(slot.enables.data());
    payload.set_byte_enable_length(static_cast<unsigned int>(slot.enables.size()));
  }
  payload.memory().tag = static_cast<std::uint64_t>(&slot - slots_.data());
  payload.memory().region = static_cast<std::uint8_t>(write ? 1 : 2);
  bytes_moved_ += length;

  requesting_ = &payload;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay(below(8) == 0 ? below(50) : 0, sc_core::SC_NS);
  const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_UPDATED) requesting_ = nullptr;
  if (status == tlm::TLM_COMPLETED) {
    requesting_ = nullptr;
    answered(payload);
  }
}

void RandomInitiator::answered(tlm::tlm_generic_payload& payload) {
  Slot& slot = slots_[static_cast<PooledPayload&>(payload).memory().tag];
  ++checks_;
  if (!payload.is_response_ok() || slot.data != slot.expected) ++failures_;
  slot.payload = nullptr;
  payload.release();
  changed_.notify(sc_core::SC_ZERO_TIME);
}

tlm::tlm_sync_enum RandomInitiator::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                                    tlm::tlm_phase& phase, sc_core::sc_time&) {
  if (requesting_ == &payload) requesting_ = nullptr;
  changed_.notify(sc_core::SC_ZERO_TIME);
  if (phase == tlm::END_REQ) return tlm::TLM_ACCEPTED;
  if (below(3) == 0) {
    held_up_ = &payload;
    answer_held_.notify(sc_core::SC_ZERO_TIME);
    return tlm::TLM_ACCEPTED;
  }
  answered(payload);
  phase = tlm::END_RESP;
  return tlm::TLM_COMPLETED;
}

void RandomInitiator::hold_up_answers() {
  while (true) {
    wait(answer_held_);
    wait(sc_core::sc_time(1 + below(120), sc_core::SC_NS));
    tlm::tlm_generic_payload& payload = *held_up_;
    held_up_ = nullptr;
    tlm::tlm_phase phase = tlm::END_RESP;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    payload.acquire();
    socket->nb_transport_fw(payload, phase, delay);
    answered(payload);
    payload.release();
  }
}

}  // namespace sgs
