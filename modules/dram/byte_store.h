// The bytes of the modelled memory, in pages made when first written. What was never written is 0.
#pragma once

#include <cstddef>
#include <cstdint>
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

  std::uint64_t allocated_bytes() const { return allocated_pages_ * kPageBytes; }

  static constexpr std::size_t kPageBytes = 4096;

 private:
  void check(std::uint64_t address, std::size_t bytes) const;

  std::uint64_t capacity_bytes_;
  std::uint64_t allocated_pages_ = 0;
  std::vector<std::unique_ptr<std::uint8_t[]>> pages_;
};

}  // namespace sgs
