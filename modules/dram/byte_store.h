// The bytes of the modelled memory, in blocks made when first written. Bytes never written are 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <tlm>
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

// Access of a generic payload to a store of bytes, and the response it deserves.

// Moves the payload's bytes, byte enables respected, and sets its response: OK, or the TLM error
// for a range outside the store, a streaming width below the length, an empty byte-enable array, or
// a command that is neither read nor write; on an error no byte moves. True when OK.
bool move_bytes(tlm::tlm_generic_payload& payload, ByteStore& store);

// A note on a payload that waits out its annotated delay: which initiator it came from.
struct ArrivingFrom : tlm::tlm_extension<ArrivingFrom> {
  int initiator = 0;

  tlm_extension_base* clone() const override { return new ArrivingFrom(*this); }
  void copy_from(const tlm_extension_base& other) override {
    initiator = static_cast<const ArrivingFrom&>(other).initiator;
  }
};

}  // namespace sgs
