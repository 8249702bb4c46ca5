// The bytes of the modelled memory, in blocks made when first written.
#include "modules/dram/byte_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

namespace sgs {

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

}  // namespace sgs
