// tb_dram's own test: the memory alone, directed and random, against a byte mirror.
#pragma once

#include <cstdint>

#include "algorithm/files/output_file.h"
#include "modules/dram/dram_config.h"

namespace sgs {

struct SelfCheck {
  DramConfig dram;
  std::uint64_t seed = 1;
  std::uint64_t transactions = 3000;  // by each random initiator
  OutputFile* vcd = nullptr;          // null: none
  OutputFile* dram_trace = nullptr;   // null: none
};

// Elaborates and simulates here: once a process, after use_femtosecond_resolution(). Prints a PASS
// or FAIL line for each group of checks with its counts; true when all pass.
bool run_self_check(const SelfCheck& check);

}  // namespace sgs
