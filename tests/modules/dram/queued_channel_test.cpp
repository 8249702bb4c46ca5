// Scheduling, refresh and power states of one channel.
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

TEST_CASE("queued channel: the shorter strobe brings data three cycles earlier") {
  DramConfig config = quiet_config();
  config.read_strobe = ReadStrobe::kMin;
  Bench b(config);
  b.read(0, 0, 0);
  CHECK(b.completion() == 15 + 12 + 2 + 4);
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
    r.urgent = r.direction == Direction::kRead && random() % 4 == 0;
    r.bank = static_cast<std::uint32_t>(random() % 2);
    r.row = static_cast<std::uint32_t>(random() % 2);
    r.burst = static_cast<std::uint32_t>(random() % 6);
    r.bursts = 1 + static_cast<std::uint32_t>(random() % 3);
    r.masked = r.direction == Direction::kWrite && random() % 3 == 0;
    if (b.channel.full(r)) continue;
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

TEST_CASE(
    "power states: a longer idle rank refreshes itself, with one refresh after what woke it") {
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
        "ACT@0 RD@15 PREA@515 SRE@532 SRX@100000 ACT@100112 RD@100127 PREA@100146 REFA@100163");
}

TEST_CASE("power states: bank by bank all are refreshed before the rank refreshes itself again") {
  DramConfig config = quiet_config();
  config.refresh = RefreshMode::kPerBank;
  config.self_refresh_idle_cycles = 500;
  Bench b(config);
  b.read(0, 0, 1);
  b.channel.advance(100000);
  b.read(100000, 0, 1);
  b.channel.advance(200000);
  const std::string text = b.sink.text();
  const std::string after = text.substr(text.find("SRX@100000"));
  const std::string awake = after.substr(0, after.find("SRE@"));
  std::size_t refreshes = 0;
  for (std::size_t at = 0; (at = awake.find("REFB@", at)) != std::string::npos; ++at) ++refreshes;
  INFO(text);
  CHECK(refreshes == 8);
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
