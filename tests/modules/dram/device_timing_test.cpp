// Device tables: each constraint alone, by hand from LPDDR3-1600's numbers.
#include "modules/dram/device_timing.h"

#include <catch2/catch.hpp>

namespace sgs {
namespace {

using R = RequestCommand;

DeviceTiming make_device(std::uint32_t ranks = 1, WriteLatencySet set = WriteLatencySet::kA) {
  const Memspec memspec = load_memspec("lpddr3_1600_4gb");
  return DeviceTiming(memspec, DerivedTiming(memspec, set, ReadStrobe::kMax), ranks);
}

TEST_CASE("device timing: sums of constants") {
  const Memspec memspec = load_memspec("lpddr3_1600_4gb");
  const DerivedTiming a(memspec, WriteLatencySet::kA, ReadStrobe::kMax);
  CHECK(a.read_to_write == 16);
  CHECK(a.write_to_read == 17);
  CHECK(a.read_data_end == 12 + 5 + 4);
  CHECK(a.write_data_end == 6 + 1 + 4);
  const DerivedTiming b(memspec, WriteLatencySet::kB, ReadStrobe::kMin);
  CHECK(b.read_to_write == 13);
  CHECK(b.write_to_read == 20);
  CHECK(b.read_data_end == 12 + 2 + 4);
}

TEST_CASE("device timing: after an activate") {
  DeviceTiming d = make_device();
  d.activate(0, 2, 77, 1000);
  CHECK(d.open_row(0, 2) == 77);
  CHECK(d.open_banks(0) == 1);
  CHECK(d.earliest(R::kRead, 0, 2) == 1015);
  CHECK(d.earliest(R::kWrite, 0, 2) == 1015);
  CHECK(d.earliest(R::kPrecharge, 0, 2) == 1034);
  CHECK(d.earliest(R::kActivate, 0, 2) == 1048);
  CHECK(d.earliest(R::kActivate, 0, 3) == 1008);
}

TEST_CASE("device timing: the fifth activate waits for the window of four") {
  DeviceTiming d = make_device();
  for (std::uint32_t b = 0; b < 4; ++b) d.activate(0, b, 0, 100 + 8 * b);
  CHECK(d.earliest(R::kActivate, 0, 4) == 140);
  d.activate(0, 4, 0, 140);
  CHECK(d.earliest(R::kActivate, 0, 5) == 148);
}

TEST_CASE("device timing: after a read") {
  DeviceTiming d = make_device(2);
  d.activate(0, 0, 5, 0);
  d.read(0, 0, 100);
  CHECK(d.earliest(R::kRead, 0, 0) == 104);
  CHECK(d.earliest(R::kWrite, 0, 0) == 116);
  CHECK(d.earliest(R::kPrecharge, 0, 0) == 106);
  CHECK(d.earliest(R::kRead, 1, 0) == 106);   // BL/2 + RTRS
  CHECK(d.earliest(R::kWrite, 1, 0) == 117);  // RL + DQSCKmax + BL/2 + RTRS - WL
  CHECK(d.earliest_power_down(0) == 122);
}

TEST_CASE("device timing: after a write") {
  DeviceTiming d = make_device(2);
  d.activate(0, 0, 5, 0);
  d.write(0, 0, 100);
  CHECK(d.earliest(R::kWrite, 0, 0) == 104);
  CHECK(d.earliest(R::kRead, 0, 0) == 117);
  CHECK(d.earliest(R::kPrecharge, 0, 0) == 123);
  CHECK(d.earliest(R::kWrite, 1, 0) == 106);
  CHECK(d.earliest(R::kRead, 1, 0) == 101);  // WL + 1 + BL/2 + RTRS - RL - DQSCKmin is below 1
  CHECK(d.earliest_power_down(0) == 123);
}

TEST_CASE("device timing: precharges") {
  DeviceTiming d = make_device();
  d.activate(0, 0, 5, 0);
  d.activate(0, 1, 5, 8);
  CHECK(d.earliest_precharge_all(0) == 42);
  d.precharge(0, 0, 50);
  CHECK(d.open_row(0, 0) == kNoRow);
  CHECK(d.earliest(R::kActivate, 0, 0) == 65);
  d.precharge_all(0, 60);
  CHECK(d.open_banks(0) == 0);
  CHECK(d.earliest(R::kActivate, 0, 1) == 77);
  CHECK(d.earliest(R::kActivate, 0, 5) == 77);
  CHECK(d.earliest_refresh_all(0) == 77);
}

TEST_CASE("device timing: auto-precharge starts after tRTP or tWR but not before tRAS") {
  for (const std::uint64_t read_at : {15u, 40u}) {
    DeviceTiming d = make_device();
    d.activate(0, 0, 5, 0);
    d.read(0, 0, read_at);
    d.close_after_column(0, 0);
    CHECK(d.open_row(0, 0) == kNoRow);
    CHECK(d.earliest(R::kActivate, 0, 0) == (read_at == 15 ? 34u + 15u : 46u + 15u));
  }
  DeviceTiming d = make_device();
  d.activate(0, 0, 5, 0);
  d.write(0, 0, 40);
  d.close_after_column(0, 0);
  CHECK(d.earliest(R::kActivate, 0, 0) == 40 + 11 + 12 + 15);
  CHECK(d.earliest_precharge_all(0) == 40 + 11 + 12);
}

TEST_CASE("device timing: refreshes") {
  DeviceTiming d = make_device();
  d.refresh_all(0, 1000);
  CHECK(d.earliest(R::kActivate, 0, 7) == 1104);
  CHECK(d.earliest_refresh_all(0) == 1104);
  CHECK(d.earliest_power_down(0) == 1104);
  DeviceTiming e = make_device();
  e.refresh_bank(0, 3, 1000);
  CHECK(e.earliest(R::kActivate, 0, 3) == 1048);
  CHECK(e.earliest(R::kActivate, 0, 4) == 1008);
  CHECK(e.earliest_refresh_bank(0, 4) == 1048);
  CHECK(e.earliest_refresh_all(0) == 1048);
  // It counts towards the window of four.
  for (std::uint32_t b = 0; b < 3; ++b) e.activate(0, b, 0, 1008 + 8 * b);
  CHECK(e.earliest(R::kActivate, 0, 4) == 1040);
}

TEST_CASE("device timing: low-power states") {
  DeviceTiming d = make_device();
  d.activate(0, 0, 5, 0);
  d.enter_power_down(0, 100);
  CHECK(d.earliest_exit(0) == 106);
  d.exit_power_down(0, 150);
  CHECK(d.earliest(R::kRead, 0, 0) == 156);
  CHECK(d.earliest(R::kActivate, 0, 1) == 156);
  CHECK(d.earliest(R::kPrecharge, 0, 0) == 156);
  CHECK(d.earliest_power_down(0) == 156);
  DeviceTiming e = make_device();
  e.enter_self_refresh(0, 100);
  CHECK(e.earliest_exit(0) == 112);
  e.exit_self_refresh(0, 200);
  CHECK(e.earliest(R::kActivate, 0, 0) == 312);
  CHECK(e.earliest_refresh_all(0) == 312);
}

}  // namespace
}  // namespace sgs
