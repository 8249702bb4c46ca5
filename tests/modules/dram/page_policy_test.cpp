// When a row is closed: the policies as a channel asks them.
#include "modules/dram/page_policy.h"

#include <catch2/catch.hpp>

#include "tests/modules/dram/channel_bench.h"

namespace sgs {
namespace {

using test::Bench;
using test::quiet_config;

TEST_CASE("page policy: closed closes with the last known hit, open keeps the row") {
  DramConfig config = quiet_config();
  config.page_policy = PagePolicyKind::kClosed;
  Bench b(config);
  b.read(0, 0, 1);
  b.read(0, 0, 1);
  b.channel.advance(1000);
  CHECK(b.sink.text() == "ACT@0 RD@15 RDA@19");
  b.read(2000, 0, 2);
  CHECK(b.completion() == 15 + 12 + 5 + 4);    // tRCD, then RL + tDQSCKmax + BL/2
  CHECK(b.sink.records.back().cycle == 2015);  // no precharge in the way: as fast as a closed bank
  config.page_policy = PagePolicyKind::kOpen;
  Bench open(config);
  open.read(0, 0, 1);
  open.channel.advance(1000);
  CHECK(open.sink.text() == "ACT@0 RD@15");
}

// Rows of one bank that take turns; when the last was asked for.
std::uint64_t conflicts(Bench& b) {
  std::uint64_t cycle = 0;
  for (std::uint32_t row = 0; row < 6; ++row) b.read(cycle += 1000, 0, row);
  return cycle;
}

TEST_CASE("page policy: adaptive turns to closing under conflicts and back under hits") {
  DramConfig config = quiet_config();
  config.page_policy = PagePolicyKind::kAdaptive;
  Bench b(config);
  std::uint64_t cycle = conflicts(b);
  b.channel.advance(cycle += 1000);
  CHECK(b.sink.count(Command::kReadAuto) >= 3);
  CHECK(b.sink.records.back().command == Command::kReadAuto);
  for (int i = 0; i < 6; ++i) b.read(cycle += 1000, 0, 5);
  b.channel.advance(cycle += 1000);
  CHECK(b.sink.records.back().command == Command::kRead);
}

TEST_CASE("page policy: adaptive counts a hit once a request, however many its bursts") {
  DramConfig config = quiet_config();
  config.page_policy = PagePolicyKind::kAdaptive;
  Bench b(config);
  std::uint64_t cycle = conflicts(b);
  // The second finds the row open that the first had opened: enough to leave it so.
  b.read(cycle += 1000, 0, 9);
  b.push(cycle, Direction::kRead, 0, 9, 1, 4);
  b.channel.advance(cycle += 1000);
  CHECK(b.sink.records.back().command == Command::kRead);
  // And no more than that: after a conflict rows are closed again.
  b.read(cycle += 1000, 0, 10);
  b.channel.advance(cycle += 1000);
  CHECK(b.sink.records.back().command == Command::kReadAuto);
}

}  // namespace
}  // namespace sgs
