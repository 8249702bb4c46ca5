// Keys of a unit's memory port.
#pragma once

#include "modules/config/config_visitor.h"
#include "tlm/memory_port.h"

namespace sgs {

inline void visit(ConfigVisitor& v, MemoryPortConfig& c) {
  v("max_transaction_bytes", c.max_transaction_bytes, in_range(32, 4096),
    "a port's longest request");
  v("max_outstanding", c.max_outstanding, in_range(1, 4096), "requests of a port in flight");
  v("max_writes", c.max_writes, in_range(1, 4096),
    "writes of these; the port keeps their bytes until they are answered");
  v("path_cycles", c.path_cycles, in_range(0, 64),
    "registers between port and channels, in each direction");
}

}  // namespace sgs
