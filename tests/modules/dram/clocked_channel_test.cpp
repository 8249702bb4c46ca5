// The commands of a channel, against a controller that is stepped cycle by cycle: every command in
// the very cycle.
#include "tests/modules/dram/clocked_channel.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>

#include "modules/dram/queued_channel.h"
#include "tests/modules/dram/recording_sink.h"

namespace sgs {
namespace {

using test::ChannelHardware;
using test::ClockedChannel;

struct DramWorkload {
  const char* name;
  std::uint32_t banks = 8, rows = 64, longest = 4, writes_percent = 30;
  std::uint32_t gap = 1;  // at most, between two requests
  ChannelHardware hardware = {};
  bool groups = false;  // bank groups, and what else only some standards have
  Memspec::CommandBus command_bus = {};
  std::uint32_t urgent_percent = 0;  // of reads
};

DramConfig config_of(const ChannelHardware& hw) {
  DramConfig c;
  c.channels = 1;
  c.refresh = hw.refresh.mode;
  c.refresh_postpone_max = static_cast<std::int32_t>(hw.refresh.most_postponed);
  c.front_end_ns = 10;  // 8 cycles of 1.25 ns
  c.scheduler = hw.hits_first ? SchedulerKind::kFrFcfs : SchedulerKind::kFcfs;
  c.age_cap_cycles = 1000000;
  c.read_queue_entries = static_cast<std::uint32_t>(hw.read_entries);
  c.write_queue_entries = static_cast<std::uint32_t>(hw.write_entries);
  c.write_high_watermark = static_cast<std::uint32_t>(hw.high_watermark);
  c.write_low_watermark = static_cast<std::uint32_t>(hw.low_watermark);
  return c;
}

// Reads of even rows, writes of odd ones: none is answered by a write that waits.
std::vector<ChannelRequest> requests_of(const DramWorkload& load, const Memspec& memspec,
                                        std::uint64_t seed, std::vector<std::uint64_t>& gaps) {
  std::mt19937_64 random(seed);
  std::vector<ChannelRequest> requests(1000);
  for (ChannelRequest& r : requests) {
    const bool write = random() % 100 < load.writes_percent;
    r.direction = write ? Direction::kWrite : Direction::kRead;
    r.urgent = !write && random() % 100 < load.urgent_percent;
    r.bank = static_cast<std::uint32_t>(random() % load.banks);
    r.row = 2 * static_cast<std::uint32_t>(random() % load.rows) + (write ? 1 : 0);
    r.bursts = 1 + static_cast<std::uint32_t>(random() % load.longest);
    r.burst = static_cast<std::uint32_t>(random() % (memspec.bursts_per_row() - r.bursts));
    gaps.push_back(1 + random() % load.gap);
  }
  return requests;
}

void add_groups(Memspec& memspec) {
  memspec.organisation.bank_groups = 4;
  memspec.organisation.beats_per_clock = 4;
  memspec.organisation.banks_per_refresh = 2;
  Memspec::Timing& t = memspec.timing_cycles;
  t.ccd = 2;
  t.ccd_l = 5;
  t.ccd_l_write = 7;
  t.rrd = 4;
  t.rrd_l = 9;
  t.wtr_l = 10;
  t.rcd_write = 8;
  t.dqss = 0;
  t.rtw = 13;
  t.pbr2pbr = 30;
  t.pbr2act = 6;
  check_memspec(memspec, "groups");
}

void compare(const DramWorkload& load) {
  Memspec memspec = load_memspec(DramConfig{}.memspec);
  if (load.hardware.refresh.any_bank) memspec.refresh_order = RefreshOrder::kAny;
  if (load.groups) add_groups(memspec);
  memspec.command_bus = load.command_bus;
  std::size_t commands = 0;
  std::uint64_t cycles = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    INFO(load.name << ", seed " << seed);
    std::vector<std::uint64_t> gaps;
    const std::vector<ChannelRequest> requests = requests_of(load, memspec, seed, gaps);
    test::RecordingSink sink;
    QueuedChannel channel(config_of(load.hardware), memspec, 0, sink);
    ClockedChannel clocked(load.hardware, memspec);
    std::uint64_t cycle = 0;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      cycle += gaps[i];
      channel.advance(cycle);
      while (channel.full(requests[i])) {
        channel.advance(cycle = channel.next_decision() + 1);
      }
      channel.push(requests[i], cycle);
    }
    while (!channel.empty()) channel.advance(channel.next_decision() + 1);
    std::size_t next = 0;
    std::uint64_t due = gaps[0], now = 0;
    for (; next < requests.size() || !clocked.empty(); ++now) {
      if (next < requests.size() && now >= due && !clocked.full(requests[next])) {
        clocked.push(requests[next++]);
        if (next < requests.size()) due = now + gaps[next];
      }
      clocked.step();
    }
    // Until the last command's last cycle.
    constexpr std::uint64_t kLongest = 8;
    for (std::uint64_t i = 0; i < kLongest; ++i, ++now) clocked.step();
    channel.advance(now);
    std::vector<ClockedChannel::Sent> expected = clocked.sent();
    while (expected.back().cycle >= now) expected.pop_back();
    REQUIRE(sink.records.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const CommandRecord& got = sink.records[i];
      INFO("command " << i);
      REQUIRE(got.cycle == expected[i].cycle);
      REQUIRE(got.command == expected[i].command);
      REQUIRE(got.bank == expected[i].bank);
      REQUIRE(got.row == expected[i].row);
      REQUIRE(got.burst == expected[i].burst);
    }
    commands += expected.size();
    cycles += expected.back().cycle;
  }
  fmt::print("{:18} {:34} {:8} {:9}, every command in the same cycle\n", "DRAM commands", load.name,
             commands, cycles);
}

TEST_CASE("clocked reference: DRAM commands") {
  ChannelHardware in_order, tiny;
  in_order.hits_first = false;
  tiny.read_entries = tiny.write_entries = 2;
  tiny.high_watermark = 2;
  tiny.low_watermark = 0;
  for (const DramWorkload& load : {
           DramWorkload{"light: a request in 100 cycles", 8, 64, 4, 30, 200},
           DramWorkload{"heavy: random rows", 8, 1000, 2, 30},
           DramWorkload{"heavy: few rows", 8, 2, 8, 30},
           DramWorkload{"reads only", 8, 8, 4, 0},
           DramWorkload{"writes only", 8, 8, 4, 100},
           DramWorkload{"one bank", 1, 4, 4, 50},
           DramWorkload{"first come, first served", 8, 64, 4, 30, 1, in_order},
           DramWorkload{"tiny queues", 8, 64, 4, 50, 1, tiny},
           DramWorkload{"bank groups, light", 8, 64, 4, 30, 200, {}, true},
           DramWorkload{"bank groups, random rows", 8, 1000, 2, 30, 1, {}, true},
           DramWorkload{"bank groups, few rows", 8, 2, 8, 30, 1, {}, true},
           DramWorkload{"bank groups, writes only", 8, 8, 4, 100, 1, {}, true},
       }) {
    compare(load);
  }
}

TEST_CASE("clocked reference: DRAM commands with urgent reads") {
  ChannelHardware in_order, tiny, any;
  in_order.hits_first = false;
  tiny.read_entries = tiny.write_entries = 2;
  tiny.high_watermark = 2;
  tiny.low_watermark = 0;
  any.refresh = {RefreshMode::kPerBank, 8, true};
  const Memspec::CommandBus lpddr4{4, 0, 4, 2, 1}, hbm{2, 0, 1, 1, 2};
  for (const DramWorkload& load : {
           DramWorkload{"a tenth, light", 8, 64, 4, 30, 200, {}, false, {}, 10},
           DramWorkload{"a tenth, random rows", 8, 1000, 2, 30, 1, {}, false, {}, 10},
           DramWorkload{"a tenth, few rows", 8, 2, 8, 30, 1, {}, false, {}, 10},
           DramWorkload{"a tenth, one bank", 1, 4, 4, 50, 1, {}, false, {}, 10},
           DramWorkload{"a half, first come", 8, 64, 4, 30, 1, in_order, false, {}, 50},
           DramWorkload{"a half, tiny queues", 8, 64, 4, 50, 1, tiny, false, {}, 50},
           DramWorkload{"all, any bank refreshed", 8, 64, 4, 30, 1, any, false, {}, 100},
           DramWorkload{"a half, 4, 4, 2 cycles", 8, 1000, 2, 30, 1, any, false, lpddr4, 50},
           DramWorkload{"a half, bank groups, two buses", 8, 2, 8, 30, 1, {}, true, hbm, 50},
       }) {
    compare(load);
  }
}

TEST_CASE("clocked reference: DRAM commands of several cycles, and of two buses") {
  ChannelHardware all, any, in_order;
  all.refresh = {RefreshMode::kAllBank, 2};
  any.refresh = {RefreshMode::kPerBank, 8, true};
  in_order.hits_first = false;
  // As of LPDDR4, LPDDR5, DDR5 and HBM.
  const Memspec::CommandBus lpddr4{4, 0, 4, 2, 1}, lpddr5{2, 1, 1, 1, 1}, ddr5{2, 0, 2, 1, 1},
      hbm{2, 0, 1, 1, 2};
  for (const DramWorkload& load : {
           DramWorkload{"4, 4, 2 cycles, light", 8, 64, 4, 30, 200, {}, false, lpddr4},
           DramWorkload{"4, 4, 2 cycles, random rows", 8, 1000, 2, 30, 1, {}, false, lpddr4},
           DramWorkload{"4, 4, 2 cycles, any bank", 8, 1000, 2, 30, 1, any, false, lpddr4},
           DramWorkload{"4, 4, 2 cycles, all banks", 8, 64, 4, 30, 40, all, false, lpddr4},
           DramWorkload{"1 + 1 cycles, light", 8, 64, 4, 30, 200, {}, true, lpddr5},
           DramWorkload{"1 + 1 cycles, random rows", 8, 1000, 2, 30, 1, {}, true, lpddr5},
           DramWorkload{"1 + 1 cycles, in order", 8, 64, 4, 30, 1, in_order, true, lpddr5},
           DramWorkload{"1 + 1 cycles, any bank", 8, 1000, 2, 30, 1, any, true, lpddr5},
           DramWorkload{"2, 2, 1 cycles, few rows", 8, 2, 8, 30, 1, {}, true, ddr5},
           DramWorkload{"2, 2, 1 cycles, random rows", 8, 1000, 2, 30, 1, all, true, ddr5},
           DramWorkload{"two buses, light", 8, 64, 4, 30, 200, {}, true, hbm},
           DramWorkload{"two buses, random rows", 8, 1000, 2, 30, 1, {}, true, hbm},
           DramWorkload{"two buses, any bank", 8, 1000, 2, 30, 1, any, true, hbm},
           DramWorkload{"two buses, all banks", 8, 64, 4, 30, 40, all, true, hbm},
       }) {
    compare(load);
  }
}

TEST_CASE("clocked reference: DRAM commands with refresh") {
  const auto refreshed = [](RefreshMode mode, std::uint32_t most_postponed) {
    ChannelHardware hardware;
    hardware.refresh = {mode, most_postponed};
    return hardware;
  };
  const ChannelHardware all = refreshed(RefreshMode::kAllBank, 0);
  const ChannelHardware bank = refreshed(RefreshMode::kPerBank, 0);
  const ChannelHardware all_late = refreshed(RefreshMode::kAllBank, 2);
  const ChannelHardware bank_late = refreshed(RefreshMode::kPerBank, 8);
  ChannelHardware in_order = bank, tiny = bank_late;
  in_order.hits_first = false;
  tiny.read_entries = tiny.write_entries = 2;
  tiny.high_watermark = 2;
  tiny.low_watermark = 0;
  ChannelHardware any = bank_late, any_late = refreshed(RefreshMode::kPerBank, 3), any_tiny = tiny;
  ChannelHardware any_now = bank;
  for (ChannelHardware* hardware : {&any, &any_late, &any_tiny, &any_now}) {
    hardware->refresh.any_bank = true;
  }
  for (const DramWorkload& load : {
           DramWorkload{"all banks, light", 8, 64, 4, 30, 200, all},
           DramWorkload{"all banks, heavy: random rows", 8, 1000, 2, 30, 1, all},
           DramWorkload{"all banks, heavy: few rows", 8, 2, 8, 30, 1, all},
           DramWorkload{"all banks, one bank asked for", 1, 4, 4, 50, 1, all},
           DramWorkload{"all banks, 2 late, light", 8, 64, 4, 30, 200, all_late},
           DramWorkload{"all banks, 2 late, medium", 8, 64, 4, 30, 40, all_late},
           DramWorkload{"all banks, 2 late, heavy", 8, 1000, 2, 30, 1, all_late},
           DramWorkload{"a bank, light", 8, 64, 4, 30, 200, bank},
           DramWorkload{"a bank, heavy: random rows", 8, 1000, 2, 30, 1, bank},
           DramWorkload{"a bank, heavy: few rows", 8, 2, 8, 30, 1, bank},
           DramWorkload{"a bank, writes only", 8, 8, 4, 100, 1, bank},
           DramWorkload{"a bank, in order", 8, 64, 4, 30, 1, in_order},
           DramWorkload{"a bank, 8 late, light", 8, 64, 4, 30, 200, bank_late},
           DramWorkload{"a bank, 8 late, medium", 8, 64, 4, 30, 40, bank_late},
           DramWorkload{"a bank, 8 late, heavy", 8, 1000, 2, 30, 1, bank_late},
           DramWorkload{"a bank, 8 late, tiny queues", 8, 64, 4, 50, 1, tiny},
           DramWorkload{"any bank, light", 8, 64, 4, 30, 200, any},
           DramWorkload{"any bank, medium", 8, 64, 4, 30, 40, any},
           DramWorkload{"any bank, heavy: random rows", 8, 1000, 2, 30, 1, any},
           DramWorkload{"any bank, few banks asked for", 3, 4, 8, 30, 1, any},
           DramWorkload{"any bank, 3 late, medium", 8, 64, 4, 30, 40, any_late},
           DramWorkload{"any bank, 3 late, heavy", 8, 1000, 2, 30, 1, any_late},
           DramWorkload{"any bank, none late, medium", 8, 64, 4, 30, 40, any_now},
           DramWorkload{"any bank, none late, heavy", 8, 1000, 2, 30, 1, any_now},
           DramWorkload{"any bank, tiny queues", 8, 64, 4, 50, 1, any_tiny},
           DramWorkload{"any bank, bank groups, medium", 8, 64, 4, 30, 40, any, true},
           DramWorkload{"any bank, bank groups, heavy", 8, 1000, 2, 30, 1, any_now, true},
           DramWorkload{"any bank, bank groups, late", 8, 64, 4, 30, 1, any_late, true},
           DramWorkload{"a bank, bank groups, heavy", 8, 2, 8, 30, 1, bank_late, true},
       }) {
    compare(load);
  }
}

}  // namespace
}  // namespace sgs
