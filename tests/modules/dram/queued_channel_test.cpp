// Scheduling: unloaded latencies, policies, write drain, refresh and power states of one channel.
#include "modules/dram/queued_channel.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "tests/modules/dram/channel_bench.h"

namespace sgs {
namespace {

using test::Bench;
using test::quiet_config;

constexpr std::uint64_t kData = 12 + 5 + 4;  // RL + tDQSCKmax + BL/2

TEST_CASE("queued channel: unloaded latencies are the sums of their terms") {
  for (const std::uint32_t latency : {0u, 7u}) {
    DramConfig config = quiet_config();
    config.front_end_ns = 1.25 * latency;
    config.back_end_ns = 1.25 * 2 * latency;
    Bench b(config);
    b.read(1000, 2, 5);
    CHECK(b.completion() == 1000 + 3 * latency + 15 + kData);  // closed: tRCD
    b.read(1000000, 2, 5);
    b.channel.advance(1100000);
    QueuedChannel::Completion c{};
    REQUIRE(b.channel.take_completion(kNever, c));
    CHECK(c.cycle == 1000000 + 3 * latency + kData);  // hit
    b.read(1200000, 2, 6);
    b.channel.advance(1300000);
    REQUIRE(b.channel.take_completion(kNever, c));
    CHECK(c.cycle == 1200000 + 3 * latency + 15 + 15 + kData);  // conflict: tRPpb + tRCD
    CHECK(b.channel.rows().of(RowOutcome::kMiss) == 1);
    CHECK(b.channel.rows().of(RowOutcome::kHit) == 1);
    CHECK(b.channel.rows().of(RowOutcome::kConflict) == 1);
  }
}

TEST_CASE("queued channel: the shorter strobe brings data three cycles earlier") {
  DramConfig config = quiet_config();
  config.read_strobe = ReadStrobe::kMin;
  Bench b(config);
  b.read(0, 0, 0);
  CHECK(b.completion() == 15 + 12 + 2 + 4);
}

TEST_CASE("queued channel: a run of bursts goes out every tCCD") {
  Bench b(quiet_config());
  b.push(0, Direction::kRead, 0, 0, 16, 4);
  b.channel.advance(1000);
  CHECK(b.sink.text() == "ACT@0 RD@15 RD@19 RD@23 RD@27");
  CHECK(b.sink.records[1].burst == 16);
  CHECK(b.sink.records[4].burst == 19);
}

TEST_CASE("queued channel: next_completion is a bound that is never late") {
  Bench b(quiet_config());
  CHECK(b.channel.next_completion() == kNever);
  CHECK(b.channel.next_decision() == kNever);
  b.read(100, 0, 0);
  CHECK(b.channel.next_decision() == 100);
  CHECK(b.channel.next_completion() <= 100 + 15 + kData);
  b.channel.advance(116);
  CHECK(b.channel.next_completion() == 100 + 15 + kData);
}

TEST_CASE("scheduling: FR-FCFS lets a hit overtake, FCFS does not") {
  for (const SchedulerKind kind : {SchedulerKind::kFrFcfs, SchedulerKind::kFcfs}) {
    DramConfig config = quiet_config();
    config.scheduler = kind;
    Bench b(config);
    b.read(0, 0, 1, 1);   // opens row 1
    b.read(20, 0, 2, 2);  // conflict
    b.read(20, 0, 1, 3);  // hit, younger
    const std::vector<std::uintptr_t> expected = kind == SchedulerKind::kFrFcfs
                                                     ? std::vector<std::uintptr_t>{1, 3, 2}
                                                     : std::vector<std::uintptr_t>{1, 2, 3};
    CHECK(b.order() == expected);
  }
}

TEST_CASE("scheduling: the age cap ends a stream of hits") {
  const auto victim_completion = [](std::uint32_t cap) {
    DramConfig config = quiet_config();
    config.age_cap_cycles = cap;
    config.read_queue_entries = 64;
    Bench b(config);
    b.read(0, 0, 1, 1);
    b.read(16, 0, 2, 99);  // the victim
    std::size_t position = 0;
    for (std::uint64_t cycle = 16; cycle < 4000; cycle += 4) b.read(cycle, 0, 1, 2);
    for (const std::uintptr_t owner : b.order()) {
      ++position;
      if (owner == 99) return position;
    }
    return std::size_t{0};
  };
  CHECK(victim_completion(200) < 70);
  CHECK(victim_completion(1000) > 230);
  CHECK(victim_completion(1000) < 270);
  CHECK(victim_completion(1000000) > 990);
}

TEST_CASE("scheduling: writes wait for the high watermark and stop at the low one") {
  DramConfig config = quiet_config();
  config.write_high_watermark = 8;
  config.write_low_watermark = 3;
  config.age_cap_cycles = 100000;
  Bench b(config);
  for (std::uint32_t i = 0; i < 7; ++i) b.push(0, Direction::kWrite, 1, 5, i);
  for (std::uint32_t i = 0; i < 20; ++i) b.push(0, Direction::kRead, 0, 5, i);
  b.channel.advance(60);
  CHECK(b.sink.count(Command::kWrite) == 0);
  CHECK(b.sink.count(Command::kRead) > 5);
  b.push(60, Direction::kWrite, 1, 5, 7);  // the eighth
  b.channel.advance(100000);
  // Five writes bring eight down to three; then reads to their end, then the rest.
  std::string kinds;
  for (const CommandRecord& r : b.sink.records)
    if (is_read(r.command) || is_write(r.command)) {
      const char kind = is_read(r.command) ? 'R' : 'W';
      if (kinds.empty() || kinds.back() != kind) kinds += kind;
    }
  CHECK(kinds == "RWRW");
  std::size_t first_batch = 0;
  bool writing = false;
  for (const CommandRecord& r : b.sink.records) {
    if (is_write(r.command)) {
      writing = true;
      ++first_batch;
    } else if (writing && is_read(r.command)) {
      break;
    }
  }
  CHECK(first_batch == 5);
}

TEST_CASE("scheduling: an aged write is not starved by reads") {
  DramConfig config = quiet_config();
  config.age_cap_cycles = 300;
  Bench b(config);
  b.push(0, Direction::kWrite, 1, 5, 0, 1, 99);
  for (std::uint64_t cycle = 0; cycle < 2000; cycle += 6) b.read(cycle, 0, 1, 1);
  b.channel.advance(2000);
  QueuedChannel::Completion c{};
  bool written = false;
  while (b.channel.take_completion(kNever, c))
    written = written || reinterpret_cast<std::uintptr_t>(c.owner) == 99;
  CHECK(written);
}

TEST_CASE("scheduling: a read of bytes that wait to be written is answered from the queue") {
  DramConfig config = quiet_config();
  Bench b(config);
  for (std::uint32_t i = 0; i < 10; ++i) b.push(0, Direction::kRead, 0, 5, i);
  b.push(0, Direction::kWrite, 1, 5, 4, 4);
  b.push(10, Direction::kRead, 1, 5, 6, 2, 7);
  QueuedChannel::Completion c{};
  REQUIRE(b.channel.take_completion(11, c));
  CHECK(reinterpret_cast<std::uintptr_t>(c.owner) == 7);
  CHECK(b.channel.forwarded_reads() == 1);
  b.push(11, Direction::kRead, 1, 5, 6, 4);  // partly covered: from the device
  CHECK(b.channel.forwarded_reads() == 1);
}

// Of one burst the k-th read comes behind all writes that were pushed before it, whole or masked;
// but for reads that a waiting write answers.
TEST_CASE("scheduling: no read goes before an older write to the same bytes") {
  std::mt19937_64 random(5);
  DramConfig config = quiet_config();
  config.write_high_watermark = 12;
  Bench b(config);
  using Burst = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // bank, row, in the row
  std::map<Burst, std::uint32_t> written;
  std::map<Burst, std::vector<std::uint32_t>> read_behind;  // of each read, writes before it
  std::uint64_t cycle = 0, forwarded = 0, behind = 0;
  for (int k = 0; k < 20000; ++k) {
    cycle += random() % 12;
    b.channel.advance(cycle);
    ChannelRequest r;
    r.direction = random() % 2 == 0 ? Direction::kRead : Direction::kWrite;
    r.bank = static_cast<std::uint32_t>(random() % 2);
    r.row = static_cast<std::uint32_t>(random() % 2);
    r.burst = static_cast<std::uint32_t>(random() % 6);
    r.bursts = 1 + static_cast<std::uint32_t>(random() % 3);
    r.masked = r.direction == Direction::kWrite && random() % 3 == 0;
    if (b.channel.full(r.direction)) continue;
    b.channel.push(r, cycle);
    const bool answered = b.channel.forwarded_reads() > forwarded;
    forwarded = b.channel.forwarded_reads();
    for (std::uint32_t at = r.burst; at < r.burst + r.bursts && !answered; ++at) {
      const Burst burst{r.bank, r.row, at};
      if (r.direction == Direction::kWrite) {
        ++written[burst];
      } else {
        read_behind[burst].push_back(written[burst]);
      }
    }
  }
  b.channel.advance(cycle + 1000000);
  std::map<Burst, std::uint32_t> writes, reads;
  std::uint32_t open_row[8] = {};
  for (const CommandRecord& command : b.sink.records) {
    if (command.command == Command::kActivate) open_row[command.bank] = command.row;
    const Burst burst{command.bank, open_row[command.bank], command.burst};
    if (is_write(command.command)) ++writes[burst];
    if (!is_read(command.command)) continue;
    const std::uint32_t at = reads[burst]++;
    REQUIRE(at < read_behind[burst].size());
    REQUIRE(writes[burst] >= read_behind[burst][at]);
    behind += read_behind[burst][at] > 0 ? 1 : 0;
  }
  CHECK(writes == written);
  for (const auto& [burst, of_burst] : read_behind) CHECK(reads[burst] == of_burst.size());
  CHECK(forwarded > 100);
  CHECK(behind > 1000);
}

TEST_CASE("refresh: idle time is caught up with, one each tREFI") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kAllBank;
  Bench b(config);
  b.channel.advance(3120 * 10 + 1);
  CHECK(b.sink.count(Command::kRefreshAll) == 10);
  for (std::size_t i = 0; i < b.sink.records.size(); ++i)
    CHECK(b.sink.records[i].cycle == 3120 * (i + 1));
}

TEST_CASE("refresh: a request that comes during one waits for its end") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kAllBank;
  Bench b(config);
  b.read(3130, 0, 0);
  b.channel.advance(4000);
  CHECK(b.sink.text() == "REFA@3120 ACT@3224 RD@3239");
}

TEST_CASE("refresh: postponed ones come back to back when they must, or as soon as it is quiet") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kAllBank;
  config.refresh_postpone_max = 3;
  Bench busy(config);
  std::uint64_t busy_cycle = 0;
  for (; busy_cycle < 3120 * 4; busy_cycle += 20) busy.read(busy_cycle, 0, 1);
  CHECK(busy.sink.count(Command::kRefreshAll) == 0);
  for (; busy_cycle < 3120 * 5; busy_cycle += 20) busy.read(busy_cycle, 0, 1);
  busy.channel.advance(busy_cycle);
  CHECK(busy.sink.count(Command::kRefreshAll) == 4);
  Bench quiet(config);
  for (std::uint64_t cycle = 0; cycle < 3120 + 500; cycle += 20) quiet.read(cycle, 0, 1);
  quiet.channel.advance(3120 + 700);
  CHECK(quiet.sink.count(Command::kRefreshAll) == 1);
}

TEST_CASE("refresh: per bank goes round the banks and leaves the others working") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kPerBank;
  Bench b(config);
  b.channel.advance(390 * 9);
  REQUIRE(b.sink.count(Command::kRefreshBank) == 8);
  for (std::uint32_t i = 0; i < 8; ++i) CHECK(b.sink.records[i].bank == i);
  b.sink.records.clear();
  b.read(390 * 9 + 1, 3, 0);  // bank 0 refreshes at 3510
  b.channel.advance(390 * 9 + 100);
  CHECK(b.sink.text() == "REFB@3510 ACT@3518 RD@3533");
}

// A channel whose controller names the bank of a refresh, or else its device.
struct RefreshBench {
  RefreshBench(const DramConfig& config, RefreshOrder order)
      : memspec(with(order)), channel(config, memspec, 0, sink) {}
  static Memspec with(RefreshOrder order) {
    Memspec memspec = load_memspec(DramConfig{}.memspec);
    memspec.refresh_order = order;
    return memspec;
  }
  // Cycle and bank of each.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> refreshes() const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> of;
    for (const CommandRecord& r : sink.records) {
      if (r.command == Command::kRefreshBank) of.emplace_back(r.cycle, r.bank);
    }
    return of;
  }
  const Memspec memspec;
  test::RecordingSink sink;
  QueuedChannel channel;
};

TEST_CASE("refresh: one that may go to any bank avoids those in use, as often as is allowed") {
  for (const std::int32_t most : {-1, 0, 3, 8}) {
    DramConfig config = quiet_config();
    config.refresh = RefreshMode::kPerBank;
    config.refresh_postpone_max = most;
    RefreshBench b(config, RefreshOrder::kAny);
    // Requests for banks 0 to 2 without a gap, until more are owed after the first round.
    std::uint64_t cycle = 1;
    for (std::uint32_t i = 0; cycle < 390 * 30; ++i) {
      b.channel.advance(cycle);
      while (b.channel.full(Direction::kRead))
        b.channel.advance(cycle = b.channel.next_decision() + 1);
      ChannelRequest request;
      request.bank = i % 3;
      request.row = i;
      request.bursts = 1;
      b.channel.push(request, cycle);
    }
    const auto refreshes = b.refreshes();
    REQUIRE(refreshes.size() > 8);
    INFO("at most " << most);
    // Idle banks at once, one each tREFIpb; banks in use when more are owed than may be.
    for (std::uint32_t i = 0; i < 5; ++i) {
      CHECK(refreshes[i].second == i + 3);
      CHECK(refreshes[i].first / 390 == i + 1);
    }
    const std::uint32_t late = most < 0 ? 8 : static_cast<std::uint32_t>(most);
    for (std::uint32_t i = 5; i < 8; ++i) {
      CHECK(refreshes[i].second == i - 5);
      CHECK(refreshes[i].first / 390 == i + 1 + late);
    }
  }
}

TEST_CASE("refresh: a request that is not through the front end is not seen") {
  const auto refreshed = [](RefreshOrder order, std::uint64_t arrival) {
    DramConfig config = quiet_config();
    config.refresh = RefreshMode::kPerBank;
    config.refresh_postpone_max = 2;
    config.front_end_ns = 10;  // 8 cycles
    RefreshBench b(config, order);
    b.channel.advance(arrival);
    b.channel.push(ChannelRequest{}, arrival);  // of bank 0
    b.channel.advance(600);
    return b.refreshes().at(0);
  };
  using Refresh = std::pair<std::uint64_t, std::uint32_t>;
  CHECK(refreshed(RefreshOrder::kAny, 383) == Refresh{390, 0});
  CHECK(refreshed(RefreshOrder::kAny, 382) == Refresh{390, 1});
  CHECK(refreshed(RefreshOrder::kInTurn, 383) == Refresh{390, 0});
  CHECK(refreshed(RefreshOrder::kInTurn, 382) > Refresh{390, 0});  // postponed
}

TEST_CASE("refresh: after self-refresh the device counts its banks from the first again") {
  for (const RefreshOrder order : {RefreshOrder::kInTurn, RefreshOrder::kAny}) {
    DramConfig config = quiet_config();
    config.refresh = RefreshMode::kPerBank;
    config.self_refresh_idle_cycles = 1000;
    RefreshBench b(config, order);
    b.channel.advance(50000);
    REQUIRE(b.sink.count(Command::kSelfRefreshEnter) == 1);
    REQUIRE(b.refreshes().back().second == 1);
    ChannelRequest request;
    request.bank = 5;
    b.channel.push(request, 50000);
    b.channel.advance(51000);
    CHECK(b.refreshes().at(2).second == 0);
    CHECK(b.refreshes().at(3).second == 1);
  }
}

TEST_CASE("power states: an idle rank powers down, refreshes, and wakes for a request") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kAllBank;
  config.power_down_idle_cycles = 100;
  Bench b(config);
  b.read(0, 0, 1);
  b.channel.advance(3300);
  // The refresh wakes it at 3120, closes the row, refreshes, and it sleeps again.
  CHECK(b.sink.text() == "ACT@0 RD@15 PDE@115 PDX@3120 PREA@3126 REFA@3143 PDE@3247");
  b.sink.records.clear();
  b.read(4000, 0, 1);
  b.channel.advance(4100);
  CHECK(b.sink.text() == "PDX@4000 ACT@4006 RD@4021");
}

TEST_CASE("power states: a longer idle rank refreshes itself, with one refresh after waking") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kAllBank;
  config.self_refresh_idle_cycles = 500;
  Bench b(config);
  b.read(0, 0, 1);
  b.channel.advance(100000);
  CHECK(b.sink.text() == "ACT@0 RD@15 PREA@515 SRE@532");
  b.read(100000, 0, 1);
  b.channel.advance(100500);
  CHECK(b.sink.text() ==
        "ACT@0 RD@15 PREA@515 SRE@532 SRX@100000 REFA@100112 ACT@100216 RD@100231");
}

TEST_CASE("two ranks: reads that change rank pay the hand-over of the bus") {
  DramConfig config = quiet_config();
  config.ranks = 2;
  Bench b(config);
  ChannelRequest r;
  b.channel.push(r, 0);
  r.rank = 1;
  b.channel.push(r, 0);
  b.channel.advance(1000);
  CHECK(b.sink.text() == "ACT@0 ACT@1 RD@15 RD@21");
}

}  // namespace
}  // namespace sgs
