// The codebook buffer as a fine filter sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>

#include "algorithm/memory/second_half.h"
#include "tlm/activity.h"

namespace sgs {

class CodebookIf : public virtual sc_core::sc_interface {
 public:
  // Reads the entries of one record for reader number `reader`: lets the time pass until the last
  // line is there, before all else until the buffer is full.
  virtual void read_entries(std::uint32_t reader, const CodebookIndices& indices,
                            Activity& activity) = 0;

  // The contents; valid once read_entries() has returned.
  virtual const std::byte* bytes() const = 0;
};

// Left open where second halves are not quantised.
using CodebookIn = sc_core::sc_port<CodebookIf, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

}  // namespace sgs
