// The bytes of the modelled memory, in blocks made when first written.
#include "modules/dram/byte_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

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

ByteStore::ByteStore(std::uint64_t capacity_bytes)
    : capacity_bytes_(capacity_bytes), blocks_((capacity_bytes + kBlockBytes - 1) / kBlockBytes) {}

void ByteStore::check(std::uint64_t address, std::size_t bytes) const {
  if (address > capacity_bytes_ || bytes > capacity_bytes_ - address)
    throw std::out_of_range(fmt::format("memory: {} bytes at {:#x}, expected within {} bytes",
                                        bytes, address, capacity_bytes_));
}

void ByteStore::read(std::uint64_t address, std::uint8_t* into, std::size_t bytes) const {
  check(address, bytes);
  while (bytes > 0) {
    const std::size_t offset = address % kBlockBytes;
    const std::size_t part = std::min(bytes, kBlockBytes - offset);
    const std::uint8_t* block = blocks_[address / kBlockBytes].get();
    if (block != nullptr)
      std::memcpy(into, block + offset, part);
    else
      std::memset(into, 0, part);
    address += part;
    into += part;
    bytes -= part;
  }
}

void ByteStore::write(std::uint64_t address, const std::uint8_t* from, std::size_t bytes) {
  check(address, bytes);
  while (bytes > 0) {
    const std::size_t offset = address % kBlockBytes;
    const std::size_t part = std::min(bytes, kBlockBytes - offset);
    auto& block = blocks_[address / kBlockBytes];
    if (block == nullptr) {
      block.reset(static_cast<std::uint8_t*>(std::calloc(kBlockBytes, 1)));
      if (block == nullptr) throw std::bad_alloc();
    }
    std::memcpy(block.get() + offset, from, part);
    address += part;
    from += part;
    bytes -= part;
  }
}

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
