// Where area and energy of the memory's interface come from: PHY and controller, and I/O.
#pragma once

#include <string>

#include "modules/dram/dram_config.h"
#include "testbench/cost/technology.h"

namespace sgs {

struct MemoryInterface {
  std::string memspec;  // its name
  // Of PHY and controller of a channel.
  std::string area_of;      // memory that the technology table has them for; empty: it does not say
  bool area_known = false;  // it is this one
  std::string area_source;
  // Of a transferred bit.
  double io_pj_per_bit = 0, io_pj_per_bit_low = 0, io_pj_per_bit_high = 0;
  std::string io_source;

  // Whose PHY and controller, and by which estimate where it is another's.
  std::string whose() const;
  // One line: whose PHY and controller are counted, and what I/O energy by which source.
  std::string in_words() const;
};

// Loads the memspec. Throws InputError.
MemoryInterface memory_interface_of(const DramConfig& dram, const Technology& technology);

}  // namespace sgs
