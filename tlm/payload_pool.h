// Memory manager of generic payloads: each carries a data buffer and a MemoryExtension, and returns
// to the pool when its last reference is released. Nothing is allocated once the pool is warm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <tlm>
#include <vector>

#include "tlm/memory_extension.h"

namespace sgs {

// A payload that owns a buffer. Its data pointer may point there or elsewhere.
class PooledPayload : public tlm::tlm_generic_payload {
 public:
  explicit PooledPayload(tlm::tlm_mm_interface* manager);

  MemoryExtension& memory() { return *memory_; }

  // The payload's own bytes, at least `bytes` of them; valid until the last release.
  std::uint8_t* buffer(std::size_t bytes);

 private:
  MemoryExtension* memory_;  // owned by the base class, as every extension is
  std::vector<std::uint8_t> buffer_;
};

// Must outlive every payload that it handed out.
class PayloadPool : public tlm::tlm_mm_interface {
 public:
  PayloadPool() = default;
  PayloadPool(const PayloadPool&) = delete;
  PayloadPool& operator=(const PayloadPool&) = delete;

  // A payload with one reference, every standard attribute set anew: ignore command, no data, no
  // byte enables, TLM_INCOMPLETE_RESPONSE.
  PooledPayload& acquire();

  void free(tlm::tlm_generic_payload* payload) override;

  std::size_t made() const { return all_.size(); }                   // payloads ever allocated
  std::size_t in_use() const { return all_.size() - free_.size(); }  // not yet released

 private:
  std::vector<std::unique_ptr<PooledPayload>> all_;
  std::vector<PooledPayload*> free_;
};

}  // namespace sgs
