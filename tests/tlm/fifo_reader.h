// A unit of tests that reads FIFOs.
#pragma once

#include "tlm/timed_fifo.h"

namespace sgs::test {

// Of one FIFO or more.
struct FifoReader : sc_core::sc_module {
  FifoIns<int> in{"in"};
  explicit FifoReader(const sc_core::sc_module_name& name) : sc_module(name) {}
};

}  // namespace sgs::test
