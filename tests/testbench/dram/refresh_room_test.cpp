// With refresh as dense as a memspec may ask for, requests still come through.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/config/strict_json.h"
#include "modules/dram/memspec.h"
#include "testbench/dram/stream_bench.h"
#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

using T = Memspec::Timing;

TEST_CASE("refresh: a stream ends at the limits that check_memspec draws") {
  struct Row {
    RefreshMode refresh;
    std::vector<std::pair<std::uint32_t T::*, std::uint32_t>> timing;
    Memspec::CommandBus command_bus = {};
  };
  const test::ScratchFolder scratch;
  for (const Row& row :
       std::vector<Row>{{RefreshMode::kAllBank, {{&T::refi, 120}}},
                        {RefreshMode::kPerBank, {{&T::refi_bank, 49}}},
                        {RefreshMode::kPerBank, {{&T::rrd, 389}, {&T::faw, 389}}},
                        {RefreshMode::kPerBank, {{&T::faw, 1559}}},
                        {RefreshMode::kPerBank, {{&T::ras, 3048}, {&T::rc, 3048}, {&T::rcd, 3015}}},
                        {RefreshMode::kAllBank, {{&T::refi, 124}}, {4, 0, 4, 2, 1}},
                        {RefreshMode::kPerBank, {{&T::refi_bank, 53}}, {4, 0, 4, 2, 1}},
                        {RefreshMode::kPerBank, {{&T::rrd, 385}, {&T::faw, 385}}, {4, 0, 4, 2, 1}},
                        {RefreshMode::kPerBank, {{&T::faw, 1543}}, {4, 0, 4, 2, 1}}}) {
    Memspec memspec = load_memspec("lpddr3_1600_4gb");
    for (const auto& [key, cycles] : row.timing) memspec.timing_cycles.*key = cycles;
    memspec.command_bus = row.command_bus;
    check_memspec(memspec, "row");
    StreamBench bench;
    bench.dram.memspec = scratch.write("memspec.json", config_to_json(memspec));
    bench.dram.refresh = row.refresh;
    bench.requests = 200;
    CHECK(run_stream_in_child(bench).requests == 200);
  }
}

}  // namespace
}  // namespace sgs
