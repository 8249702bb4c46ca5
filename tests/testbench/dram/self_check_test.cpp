// tb_dram's own check passes for each shipped memspec and each policy.
#include "testbench/dram/self_check.h"

#include <catch2/catch.hpp>

#include "modules/dram/memspec.h"
#include "testbench/process/child_process.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

// SystemC elaborates once a process.
bool passes(const SelfCheck& check) {
  return in_child([&] {
           use_femtosecond_resolution();
           return std::string(run_self_check(check) ? "passed" : "");
         }) == "passed";
}

TEST_CASE("self-check: every shipped memspec") {
  for (const std::string& memspec : shipped_memspecs()) {
    INFO(memspec);
    SelfCheck check;
    check.dram.memspec = memspec;
    check.transactions = 500;
    CHECK(passes(check));
  }
}

TEST_CASE("self-check: policies, modes, small queues") {
  SelfCheck check;
  check.transactions = 500;
  check.dram.page_policy = PagePolicyKind::kClosed;
  check.dram.refresh = RefreshMode::kPerBank;
  check.dram.ranks = 2;
  CHECK(passes(check));
  check.dram.page_policy = PagePolicyKind::kAdaptive;
  check.dram.bank_hash = BankHash::kXor;
  check.dram.refresh_postpone_max = 8;
  check.dram.refresh = RefreshMode::kAllBank;
  check.dram.mapping = "row:rank:bank:column:channel";
  check.dram.posted_writes = false;
  CHECK(passes(check));
  check.dram.scheduler = SchedulerKind::kFcfs;
  check.dram.read_queue_entries = 1;
  check.dram.write_queue_entries = 1;
  check.dram.write_high_watermark = 1;
  check.dram.write_low_watermark = 0;
  check.dram.power_down_idle_cycles = 20;
  check.dram.self_refresh_idle_cycles = 300;
  CHECK(passes(check));
}

}  // namespace
}  // namespace sgs
