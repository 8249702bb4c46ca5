// Memory manager of generic payloads.
#include "tlm/payload_pool.h"

namespace sgs {

PooledPayload::PooledPayload(tlm::tlm_mm_interface* manager)
    : tlm::tlm_generic_payload(manager), memory_(new MemoryExtension) {
  set_extension(memory_);
}

std::uint8_t* PooledPayload::buffer(std::size_t bytes) {
  if (buffer_.size() < bytes) buffer_.resize(bytes);
  return buffer_.data();
}

PooledPayload& PayloadPool::acquire() {
  if (free_.empty()) {
    all_.push_back(std::make_unique<PooledPayload>(this));
    free_.reserve(all_.size());
    free_.push_back(all_.back().get());
  }
  PooledPayload& payload = *free_.back();
  free_.pop_back();
  payload.acquire();
  // tlm_generic_payload::reset() leaves these as the last user had them.
  payload.set_command(tlm::TLM_IGNORE_COMMAND);
  payload.set_address(0);
  payload.set_data_ptr(nullptr);
  payload.set_data_length(0);
  payload.set_streaming_width(0);
  payload.set_byte_enable_ptr(nullptr);
  payload.set_byte_enable_length(0);
  payload.set_dmi_allowed(false);
  payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  return payload;
}

void PayloadPool::free(tlm::tlm_generic_payload* payload) {
  payload->reset();  // drops automatic extensions that others have set
  free_.push_back(static_cast<PooledPayload*>(payload));
}

}  // namespace sgs
