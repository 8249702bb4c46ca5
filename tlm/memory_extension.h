// Extension of a memory transaction beyond the generic payload: who asks, and for what.
#pragma once

#include <cstdint>
#include <tlm>

namespace sgs {

// Sticky: a pooled payload carries the same extension object for all its lives.
struct MemoryExtension : tlm::tlm_extension<MemoryExtension> {
  std::uint8_t requester = 0;  // which unit; the numbering is the accelerator's
  std::uint8_t region = 0;     // which region of the memory image
  bool urgent = false;         // a memory may serve it before what is not
  std::uint64_t tag = 0;       // the initiator's own note; interconnect and targets leave it alone

  tlm_extension_base* clone() const override { return new MemoryExtension(*this); }
  void copy_from(const tlm_extension_base& other) override {
    *this = static_cast<const MemoryExtension&>(other);
  }
};

}  // namespace sgs
