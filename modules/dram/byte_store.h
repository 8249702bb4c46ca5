// The bytes of the modelled memory, in blocks made when first written. Bytes never written are 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace sgs {

class ByteStore {
 public:
  explicit ByteStore(std::uint64_t capacity_bytes);

  std::uint64_t capacity_bytes() const { return capacity_bytes_; }

  // Both take [address, address + bytes) within the capacity; std::out_of_range otherwise.
  void read(std::uint64_t address, std::uint8_t* into, std::size_t bytes) const;
  void write(std::uint64_t address, const std::uint8_t* from, std::size_t bytes);

 private:
  // Large zeroed allocations come from the kernel page by page as they are touched. So a block
  // costs no more than the bytes written of it, and the table of blocks stays small enough for the
  // cache.
  static constexpr std::size_t kBlockBytes = 1 << 20;

  struct Free {
    void operator()(std::uint8_t* block) const { std::free(block); }
  };

  void check(std::uint64_t address, std::size_t bytes) const;

  std::uint64_t capacity_bytes_;
  std::vector<std::unique_ptr<std::uint8_t[], Free>> blocks_;
};

}  // namespace sgs
