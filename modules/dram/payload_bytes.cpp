// Access of a generic payload to a store of bytes.
#include "modules/dram/payload_bytes.h"

namespace sgs {

namespace {

tlm::tlm_response_status verdict(const tlm::tlm_generic_payload& payload, const ByteStore& store) {
  const std::uint64_t address = payload.get_address();
  const std::uint64_t length = payload.get_data_length();
  if (!payload.is_read() && !payload.is_write()) return tlm::TLM_COMMAND_ERROR_RESPONSE;
  if (length == 0 || payload.get_data_ptr() == nullptr) return tlm::TLM_GENERIC_ERROR_RESPONSE;
  if (address >= store.capacity_bytes() || length > store.capacity_bytes() - address)
    return tlm::TLM_ADDRESS_ERROR_RESPONSE;
  if (payload.get_streaming_width() < length) return tlm::TLM_BURST_ERROR_RESPONSE;
  if (payload.get_byte_enable_ptr() != nullptr && payload.get_byte_enable_length() == 0)
    return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
  return tlm::TLM_OK_RESPONSE;
}

void move_enabled(tlm::tlm_generic_payload& payload, ByteStore& store) {
  const std::uint8_t* enable = payload.get_byte_enable_ptr();
  const unsigned int period = payload.get_byte_enable_length();
  for (unsigned int i = 0; i < payload.get_data_length(); ++i) {
    if (enable[i % period] != TLM_BYTE_ENABLED) continue;
    if (payload.is_read())
      store.read(payload.get_address() + i, payload.get_data_ptr() + i, 1);
    else
      store.write(payload.get_address() + i, payload.get_data_ptr() + i, 1);
  }
}

}  // namespace

bool move_bytes(tlm::tlm_generic_payload& payload, ByteStore& store) {
  const tlm::tlm_response_status status = verdict(payload, store);
  payload.set_response_status(status);
  if (status != tlm::TLM_OK_RESPONSE) return false;
  if (payload.get_byte_enable_ptr() != nullptr)
    move_enabled(payload, store);
  else if (payload.is_read())
    store.read(payload.get_address(), payload.get_data_ptr(), payload.get_data_length());
  else
    store.write(payload.get_address(), payload.get_data_ptr(), payload.get_data_length());
  return true;
}

}  // namespace sgs
