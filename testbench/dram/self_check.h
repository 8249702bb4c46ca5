// tb_dram's own test: the memory alone, directed and random, against a byte mirror.
#pragma once

#include <cstdint>
#include <string>

#include "modules/dram/dram_config.h"
#include "tlm/memory_port.h"

namespace sgs {

struct SelfCheck {
  DramConfig dram;
  TimingMode timing = TimingMode::kAccurate;
  std::uint64_t seed = 1;
  std::uint64_t transactions = 3000;  // of each random initiator
  std::string vcd;                    // path; empty: none
  std::string dram_trace;             // path; empty: none
};

// Elaborates and simulates here: once a process, after use_femtosecond_resolution(). Prints a PASS
// or FAIL line for each group of checks with its counts; true when all pass.
bool run_self_check(const SelfCheck& check);

}  // namespace sgs
