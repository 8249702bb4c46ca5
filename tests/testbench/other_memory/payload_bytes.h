// Bytes that generic payloads read and write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tlm>
#include <vector>

namespace sgs::test {

class PayloadBytes {
 public:
  explicit PayloadBytes(std::size_t capacity) : bytes_(capacity) {}

  std::byte* data() { return bytes_.data(); }

  // Does what the payload asks for and sets its response; how many bytes were moved.
  unsigned int serve(tlm::tlm_generic_payload& payload) {
    const std::uint64_t begin = payload.get_address();
    const std::uint64_t length = payload.get_data_length();
    if (begin + length > bytes_.size()) {
      payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
      return 0;
    }
    if (payload.is_read()) {
      std::memcpy(payload.get_data_ptr(), bytes_.data() + begin, length);
    } else {
      std::memcpy(bytes_.data() + begin, payload.get_data_ptr(), length);
    }
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
    return static_cast<unsigned int>(length);
  }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace sgs::test
