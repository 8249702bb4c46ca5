// The bytes of the modelled memory, in pages made when first written.
#include "modules/dram/byte_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace sgs {

ByteStore::ByteStore(std::uint64_t capacity_bytes)
    : capacity_bytes_(capacity_bytes), pages_((capacity_bytes + kPageBytes - 1) / kPageBytes) {}

void ByteStore::check(std::uint64_t address, std::size_t bytes) const {
  if (address > capacity_bytes_ || bytes > capacity_bytes_ - address)
    throw std::out_of_range(fmt::format("memory: {} bytes at {:#x}, expected within {} bytes",
                                        bytes, address, capacity_bytes_));
}

void ByteStore::read(std::uint64_t address, std::uint8_t* into, std::size_t bytes) const {
  check(address, bytes);
  while (bytes > 0) {
    const std::size_t offset = address % kPageBytes;
    const std::size_t part = std::min(bytes, kPageBytes - offset);
    const std::uint8_t* page = pages_[address / kPageBytes].get();
    if (page != nullptr)
      std::memcpy(into, page + offset, part);
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
    const std::size_t offset = address % kPageBytes;
    const std::size_t part = std::min(bytes, kPageBytes - offset);
    std::unique_ptr<std::uint8_t[]>& page = pages_[address / kPageBytes];
    if (page == nullptr) {
      page = std::make_unique<std::uint8_t[]>(kPageBytes);
      ++allocated_pages_;
    }
    std::memcpy(page.get() + offset, from, part);
    address += part;
    from += part;
    bytes -= part;
  }
}

}  // namespace sgs
