// The independent checker finds a planted violation of every constraint, and only it.
#include "modules/dram/trace_checker.h"

#include <catch2/catch.hpp>
#include <optional>
#include <set>
#include <vector>

namespace sgs {
namespace {

using C = Command;

struct Step {
  std::uint64_t cycle;
  C command;
  std::uint8_t rank = 0;
  std::uint8_t bank = 0;
  std::uint32_t row = 0;
};

// LPDDR3-1600, 4 Gb, WL set A: RCD 15, RPpb 15, RPab 17, RAS 34, RC 48, CCD 4, RRD 8, FAW 40,
// RTP 6, WR 12, WTR 6, RL 12, WL 6, DQSCK 2..5, RFCab 104, RFCpb 48, XP 6, CKE 6, CKESR 12,
// XSR 112, RTRS 2, BL/2 4.
struct Planted {
  std::string constraint;
  std::vector<Step> before;  // legal
  Step last;                 // at its earliest legal cycle
};

std::vector<Planted> planted() {
  return {
      {"tRCD", {{0, C::kActivate}}, {15, C::kRead}},
      {"tRAS", {{0, C::kActivate}}, {34, C::kPrecharge}},
      {"tRAS", {{0, C::kActivate}}, {34, C::kPrechargeAll}},
      {"tRPpb", {{0, C::kActivate}, {34, C::kPrecharge}}, {49, C::kActivate}},
      {"tRPpb", {{0, C::kActivate}, {34, C::kPrecharge}}, {49, C::kRefreshAll}},
      {"tRPab", {{0, C::kActivate}, {34, C::kPrechargeAll}}, {51, C::kActivate, 0, 3}},
      {"tRRD", {{0, C::kActivate}}, {8, C::kActivate, 0, 1}},
      {"tRRD", {{0, C::kRefreshBank}}, {8, C::kActivate, 0, 1}},
      {"tFAW",
       {{0, C::kActivate},
        {8, C::kActivate, 0, 1},
        {16, C::kActivate, 0, 2},
        {24, C::kActivate, 0, 3}},
       {40, C::kActivate, 0, 4}},
      {"tRTP", {{0, C::kActivate}, {40, C::kRead}}, {46, C::kPrecharge}},
      {"tWR", {{0, C::kActivate}, {40, C::kWrite}}, {40 + 6 + 1 + 4 + 12, C::kPrecharge}},
      {"tWR", {{0, C::kActivate}, {40, C::kWrite}}, {40 + 6 + 1 + 4 + 12, C::kPrechargeAll}},
      {"tCCD", {{0, C::kActivate}, {15, C::kRead}}, {19, C::kRead}},
      {"tCCD", {{0, C::kActivate}, {15, C::kWrite}}, {19, C::kWrite}},
      {"read to write", {{0, C::kActivate}, {15, C::kRead}}, {15 + 16, C::kWrite}},
      {"tWTR", {{0, C::kActivate}, {15, C::kWrite}}, {15 + 17, C::kRead}},
      {"tRTRS", {{0, C::kActivate}, {1, C::kActivate, 1}, {20, C::kRead}}, {20 + 6, C::kRead, 1}},
      {"tRTRS", {{0, C::kActivate}, {1, C::kActivate, 1}, {20, C::kWrite}}, {20 + 6, C::kWrite, 1}},
      {"tRTRS read to write",
       {{0, C::kActivate}, {1, C::kActivate, 1}, {20, C::kRead}},
       {20 + 12 + 5 + 4 + 2 - 6, C::kWrite, 1}},
      {"tRFCab", {{0, C::kRefreshAll}}, {104, C::kActivate}},
      {"tRFCab", {{0, C::kRefreshAll}}, {104, C::kRefreshAll}},
      {"tRFCpb", {{0, C::kRefreshBank}}, {48, C::kActivate}},
      {"tRFCpb", {{0, C::kRefreshBank}}, {48, C::kRefreshBank, 0, 1}},
      {"read before power-down",
       {{0, C::kActivate}, {15, C::kRead}},
       {15 + 12 + 5 + 4 + 1, C::kPowerDownEnter}},
      {"write before power-down",
       {{0, C::kActivate}, {15, C::kWrite}},
       {15 + 6 + 1 + 4 + 12, C::kPowerDownEnter}},
      {"write before power-down",
       {{0, C::kActivate}, {34, C::kWriteAuto}},
       {34 + 6 + 1 + 4 + 12 + 1, C::kPowerDownEnter}},
      {"tCKE", {{0, C::kPowerDownEnter}}, {6, C::kPowerDownExit}},
      {"tXP", {{0, C::kPowerDownEnter}, {6, C::kPowerDownExit}}, {12, C::kActivate}},
      {"tCKESR", {{0, C::kSelfRefreshEnter}}, {12, C::kSelfRefreshExit}},
      {"tXSR", {{0, C::kSelfRefreshEnter}, {12, C::kSelfRefreshExit}}, {124, C::kActivate}},
      {"auto-precharge + tRPpb", {{0, C::kActivate}, {15, C::kReadAuto}}, {49, C::kActivate}},
      {"auto-precharge + tRPpb",
       {{0, C::kActivate}, {40, C::kReadAuto}},
       {40 + 6 + 15, C::kActivate}},
      {"auto-precharge + tRPpb",
       {{0, C::kActivate}, {40, C::kWriteAuto}},
       {40 + 6 + 1 + 4 + 12 + 15, C::kActivate}},
      {"command bus", {{0, C::kActivate}}, {1, C::kActivate, 1}},
  };
}

CommandRecord record(const Step& s) {
  return {s.cycle, s.command, 0, s.rank, s.bank, 0, s.command == C::kActivate ? s.row : 0, 0};
}

TraceChecker make_checker(RefreshMode refresh = RefreshMode::kAllBank) {
  CommandTraceHeader header;
  header.memspec = "lpddr3_1600_4gb";
  header.ranks = 2;
  header.refresh = refresh;
  return TraceChecker(load_memspec(header.memspec), header);
}

TEST_CASE("trace checker: every constraint is found at c - 1 and satisfied at c") {
  for (const Planted& p : planted()) {
    INFO(p.constraint << " at cycle " << p.last.cycle);
    for (const bool early : {false, true}) {
      TraceChecker checker = make_checker();
      for (const Step& step : p.before) {
        const auto found = checker.check(record(step));
        if (found) FAIL("the steps before are legal: " << found->text());
      }
      Step last = p.last;
      if (early) --last.cycle;
      // Two constraints that end at the same cycle: the planted one must be among what binds.
      const auto found = checker.check(record(last));
      if (!early) {
        CHECK_FALSE(found);
      } else {
        REQUIRE(found);
        CHECK(found->constraint == p.constraint);
        CHECK(found->earliest == p.last.cycle);
      }
    }
  }
}

// Bank groups of 4: banks 0, 4 and 8 are of one, 1 of another. Times are those of LPDDR3-1600, but
// for what is set here.
Memspec grouped_memspec() {
  Memspec memspec = load_memspec("lpddr3_1600_4gb");
  memspec.organisation.banks = 16;
  memspec.organisation.bank_groups = 4;
  memspec.organisation.banks_per_refresh = 2;
  memspec.organisation.beats_per_clock = 4;
  Memspec::Timing& t = memspec.timing_cycles;
  t.ccd = 2;
  t.ccd_l = 6;
  t.ccd_l_write = 9;
  t.rrd_l = 12;
  t.wtr_l = 11;
  t.rcd_write = 9;
  t.dqss = 3;
  t.rtw = 21;
  t.pbr2pbr = 30;
  t.pbr2act = 10;
  memspec.refresh_order = RefreshOrder::kAny;
  check_memspec(memspec, "grouped");
  return memspec;
}

TEST_CASE("trace checker: constraints of bank groups, and those that some standards have") {
  const std::vector<Planted> rows = {
      {"tCCD", {{0, C::kActivate}, {15, C::kActivate, 0, 1}, {40, C::kRead}}, {42, C::kRead, 0, 1}},
      {"tCCD_L",
       {{0, C::kActivate}, {15, C::kActivate, 0, 4}, {40, C::kRead}},
       {46, C::kRead, 0, 4}},
      {"tCCD_L_WR",
       {{0, C::kActivate}, {15, C::kActivate, 0, 4}, {40, C::kWrite}},
       {49, C::kWrite, 0, 4}},
      {"tRRD", {{0, C::kActivate}}, {8, C::kActivate, 0, 1}},
      {"tRRD_L", {{0, C::kActivate}}, {12, C::kActivate, 0, 8}},
      {"tWTR",
       {{0, C::kActivate}, {15, C::kActivate, 0, 1}, {40, C::kWrite}},
       {40 + 6 + 3 + 2 + 6, C::kRead, 0, 1}},
      {"tWTR_L",
       {{0, C::kActivate}, {15, C::kActivate, 0, 4}, {40, C::kWrite}},
       {40 + 6 + 3 + 2 + 11, C::kRead, 0, 4}},
      {"tRCD", {{0, C::kActivate}}, {9, C::kWrite}},
      {"tRCD", {{0, C::kActivate}}, {15, C::kRead}},
      {"read to write", {{0, C::kActivate}, {15, C::kRead}}, {15 + 21, C::kWrite}},
      {"tWR", {{0, C::kActivate}, {40, C::kWrite}}, {40 + 6 + 3 + 2 + 12, C::kPrecharge}},
      {"tpbR2pbR", {{0, C::kRefreshBank}}, {30, C::kRefreshBank, 0, 2}},
      {"tpbR2act", {{0, C::kRefreshBank}}, {10, C::kActivate, 0, 2}},
      {"tRFCpb", {{0, C::kRefreshBank}}, {48, C::kActivate, 0, 1}},  // refreshed with bank 0
      {"tRPpb", {{0, C::kActivate, 0, 1}, {34, C::kPrecharge, 0, 1}}, {49, C::kRefreshBank}},
  };
  CommandTraceHeader header;
  header.refresh = RefreshMode::kPerBank;
  for (const Planted& p : rows) {
    INFO(p.constraint << " at cycle " << p.last.cycle);
    for (const bool early : {false, true}) {
      TraceChecker checker(grouped_memspec(), header);
      for (const Step& step : p.before) CHECK_FALSE(checker.check(record(step)));
      Step last = p.last;
      if (early) --last.cycle;
      const auto found = checker.check(record(last));
      CHECK(found.has_value() == early);
      if (found) CHECK(found->constraint == p.constraint);
    }
  }
  const auto refreshed = [&](std::uint8_t bank, bool open) {
    TraceChecker checker(grouped_memspec(), header);
    if (open) checker.check(record({0, C::kActivate, 0, 3}));
    const auto found = checker.check(record({100, C::kRefreshBank, 0, bank}));
    return found ? found->constraint : "";
  };
  CHECK(refreshed(2, false).empty());
  CHECK(refreshed(2, true) == "refresh of an open bank");
  CHECK(refreshed(1, false) == "refresh of banks that do not go together");
}

TEST_CASE("trace checker: commands take their cycles of the command bus, each on its own") {
  using Bus = Memspec::CommandBus;
  const auto found = [](const Bus& bus, const std::vector<Step>& steps) {
    Memspec memspec = load_memspec("lpddr3_1600_4gb");
    memspec.command_bus = bus;
    CommandTraceHeader header;
    header.ranks = 2;
    TraceChecker checker(memspec, header);
    std::optional<TraceViolation> last;
    for (const Step& step : steps) {
      REQUIRE_FALSE(last);
      last = checker.check(record(step));
    }
    return last ? last->constraint + ", " + std::to_string(last->earliest) : "";
  };
  const Bus lpddr4{4, 0, 4, 2, 1}, lpddr5{2, 1, 1, 1, 1}, hbm{2, 0, 1, 1, 2};
  // Timings count from the last cycle, which is the trace's.
  CHECK(found(lpddr4, {{10, C::kActivate}, {25, C::kRead}}).empty());
  CHECK(found(lpddr4, {{10, C::kActivate}, {13, C::kActivate, 1}}) == "command bus, 14");
  CHECK(found(lpddr4, {{10, C::kActivate}, {14, C::kActivate, 1}}).empty());
  CHECK(found(lpddr4, {{10, C::kActivate}, {11, C::kRefreshAll, 1}}) == "command bus, 12");
  CHECK(found(lpddr4, {{10, C::kActivate}, {12, C::kRefreshAll, 1}}).empty());
  CHECK(found(lpddr4, {{10, C::kActivate}, {11, C::kPowerDownEnter, 1}}).empty());
  // One command between the two of an activate, none in their cycles.
  CHECK(found(lpddr5, {{9, C::kRefreshAll, 1}, {10, C::kActivate}}).empty());
  CHECK(found(lpddr5, {{8, C::kRefreshAll, 1}, {10, C::kActivate}}) == "command bus, 11");
  CHECK(found(lpddr5, {{10, C::kRefreshAll, 1}, {10, C::kActivate}}) == "command bus, 11");
  // A bus each for rows and columns.
  CHECK(found(hbm, {{10, C::kActivate}, {39, C::kRead}, {39, C::kActivate, 1}}).empty());
  CHECK(found(hbm, {{10, C::kActivate}, {11, C::kActivate, 1}}) == "command bus, 12");
  CHECK(found({}, {{10, C::kActivate}, {39, C::kRead}, {39, C::kActivate, 1}}) ==
        "command bus, 40");
}

TEST_CASE("trace checker: pseudo-channels are channels of their own") {
  const Memspec memspec = load_memspec("hbm2e_3200_16gb");
  CommandTraceHeader header;
  TraceChecker checker(memspec, header);
  CommandRecord activate = record({0, C::kActivate});
  CHECK_FALSE(checker.check(activate));
  activate.channel = 1;
  CHECK_FALSE(checker.check(activate));
  activate.channel = 2;
  CHECK(checker.check(activate)->constraint == "no such channel, rank, bank, row or burst");
}

TEST_CASE("trace checker: tRC binds where RAS + RP is shorter") {
  // With the published numbers RAS + RPpb (49) hides RC (48).
  Memspec memspec = load_memspec("lpddr3_1600_4gb");
  memspec.timing_cycles.rc = 60;
  CommandTraceHeader header;
  TraceChecker checker(memspec, header);
  checker.check(record({0, C::kActivate}));
  checker.check(record({34, C::kPrecharge}));
  const auto found = checker.check(record({59, C::kActivate}));
  REQUIRE(found);
  CHECK(found->constraint == "tRC");
  CHECK(found->earliest == 60);
}

TEST_CASE("trace checker: write to read of the other rank binds where the bus turns slowly") {
  // With the published tRTRS of 2 a single cycle is enough.
  Memspec memspec = load_memspec("lpddr3_1600_4gb");
  memspec.timing_cycles.rtrs = 10;
  CommandTraceHeader header;
  header.ranks = 2;
  TraceChecker checker(memspec, header);
  checker.check(record({0, C::kActivate}));
  checker.check(record({1, C::kActivate, 1}));
  checker.check(record({20, C::kWrite}));
  const auto found = checker.check(record({26, C::kRead, 1}));
  REQUIRE(found);
  CHECK(found->constraint == "tRTRS write to read");
  CHECK(found->earliest == 20 + 6 + 1 + 4 + 10 - 12 - 2);
}

TEST_CASE("trace checker: states that forbid a command") {
  struct Case {
    std::string constraint;
    std::vector<Step> steps;
  };
  const std::vector<Case> cases = {
      {"activate of an open bank", {{0, C::kActivate}, {1000, C::kActivate}}},
      {"column of a closed bank", {{1000, C::kRead}}},
      {"column of a closed bank", {{0, C::kActivate}, {34, C::kPrecharge}, {1000, C::kWrite}}},
      {"column of a closed bank", {{0, C::kActivate}, {34, C::kReadAuto}, {1000, C::kRead}}},
      {"refresh with an open bank", {{0, C::kActivate}, {1000, C::kRefreshAll}}},
      {"refresh with an open bank", {{0, C::kActivate}, {1000, C::kSelfRefreshEnter}}},
      {"refresh of an open bank", {{0, C::kActivate}, {1000, C::kRefreshBank}}},
      {"command while the clock enable is low", {{0, C::kPowerDownEnter}, {1000, C::kActivate}}},
      {"command while the clock enable is low", {{0, C::kSelfRefreshEnter}, {999, C::kRefreshAll}}},
      {"power-down exit without entry", {{1000, C::kPowerDownExit}}},
      {"self-refresh exit without entry", {{1000, C::kSelfRefreshExit}}},
      {"no such channel, rank, bank, row or burst", {{0, C::kActivate, 0, 8}}},
      {"no such channel, rank, bank, row or burst", {{0, C::kActivate, 2, 0}}},
      {"no such channel, rank, bank, row or burst", {{0, C::kActivate, 0, 0, 16384}}},
      {"tREFI: more than 8 postponed", {{3120 * 10, C::kActivate}}},
  };
  for (const Case& one : cases) {
    INFO(one.constraint);
    TraceChecker checker = make_checker();
    for (std::size_t i = 0; i < one.steps.size(); ++i) {
      const auto found = checker.check(record(one.steps[i]));
      const bool last = i + 1 == one.steps.size();
      REQUIRE(found.has_value() == last);
      if (last) CHECK(found->constraint == one.constraint);
    }
  }
}

TEST_CASE(
    "trace checker: per-bank refresh gives each bank its turn, in the device's order or any") {
  constexpr std::uint64_t kApart = 390;
  const auto constraint_of = [&](RefreshOrder order, const std::vector<std::uint8_t>& banks) {
    Memspec memspec = load_memspec("lpddr3_1600_4gb");
    memspec.refresh_order = order;
    CommandTraceHeader header;
    header.refresh = RefreshMode::kPerBank;
    TraceChecker checker(memspec, header);
    std::optional<TraceViolation> found;
    for (std::size_t i = 0; i < banks.size(); ++i) {
      REQUIRE_FALSE(found);
      found = checker.check(record({i * kApart, C::kRefreshBank, 0, banks[i]}));
    }
    return found ? found->constraint : "";
  };
  using O = RefreshOrder;
  CHECK(constraint_of(O::kInTurn, {0, 1, 2, 3, 4, 5, 6, 7, 0, 1}).empty());
  CHECK(constraint_of(O::kInTurn, {0, 2}) == "refresh out of turn");
  CHECK(constraint_of(O::kAny, {5, 0, 7, 1, 2, 3, 4, 6, 6, 5}).empty());
  CHECK(constraint_of(O::kAny, {5, 0, 5}) == "refreshed again before others");
}

TEST_CASE("trace checker: self-refresh begins the device's count of banks again") {
  for (const std::uint8_t bank : {std::uint8_t{0}, std::uint8_t{1}}) {
    TraceChecker checker = make_checker(RefreshMode::kPerBank);
    for (const Step& step : std::vector<Step>{
             {0, C::kRefreshBank}, {390, C::kSelfRefreshEnter}, {500, C::kSelfRefreshExit}}) {
      CHECK_FALSE(checker.check(record(step)));
    }
    const auto found = checker.check(record({800, C::kRefreshBank, 0, bank}));
    CHECK(found.has_value() == (bank == 1));
    if (found) CHECK(found->constraint == "refresh out of turn");
  }
}

TEST_CASE("trace checker: between two self-refreshes all banks are refreshed, together or each") {
  const auto constraint = [](RefreshMode mode, Command refresh, std::uint8_t refreshes) {
    TraceChecker checker = make_checker(mode);
    std::uint64_t cycle = 1000;
    CHECK_FALSE(checker.check(record({100, C::kSelfRefreshEnter})));
    CHECK_FALSE(checker.check(record({500, C::kSelfRefreshExit})));
    for (std::uint8_t bank = 0; bank < refreshes; ++bank, cycle += 200)
      CHECK_FALSE(checker.check(record({cycle, refresh, 0, bank})));
    const auto found = checker.check(record({cycle + 200, C::kSelfRefreshEnter}));
    return found ? found->constraint : "";
  };
  const std::string broken = "self-refresh again before a refresh of all banks";
  CHECK(constraint(RefreshMode::kPerBank, C::kRefreshBank, 7) == broken);
  CHECK(constraint(RefreshMode::kPerBank, C::kRefreshBank, 8).empty());
  CHECK(constraint(RefreshMode::kAllBank, C::kRefreshAll, 0) == broken);
  CHECK(constraint(RefreshMode::kAllBank, C::kRefreshAll, 1).empty());
  CHECK(constraint(RefreshMode::kOff, C::kRefreshAll, 0).empty());
}

TEST_CASE("trace checker: as many per-bank refreshes may be postponed as all-bank ones cover") {
  // Nine all-bank intervals of eight banks, and the one that passes.
  for (const std::uint64_t intervals : {9u * 8u, 9u * 8u + 1u}) {
    TraceChecker checker = make_checker(RefreshMode::kPerBank);
    const auto found = checker.check(record({intervals * 390, C::kActivate}));
    CHECK(found.has_value() == (intervals > 72));
    if (found) CHECK(found->constraint == "tREFI: more than 8 postponed");
  }
}

TEST_CASE("trace checker: a row may stay open for tRASmax") {
  Memspec memspec = load_memspec("lpddr3_1600_4gb");
  memspec.timing_cycles.refi = 55000;
  CommandTraceHeader header;
  for (const std::uint64_t closed : {56000u, 56001u}) {
    TraceChecker checker(memspec, header);
    checker.check(record({0, C::kActivate}));
    const auto found = checker.check(record({closed, C::kPrecharge}));
    CHECK(found.has_value() == (closed > 56000));
    if (found) CHECK(found->constraint == "tRASmax");
  }
}

TEST_CASE("trace checker: a sink remembers the first violation and says where") {
  TraceChecker checker = make_checker();
  checker.on_command(record({0, C::kActivate, 0, 3}));
  checker.on_command(record({10, C::kRead, 0, 3}));
  checker.on_command(record({11, C::kRead, 0, 3}));
  REQUIRE(checker.first());
  CHECK(checker.first()->text() ==
        "cycle 10: channel 0 RD rank 0 bank 3: tRCD, legal from cycle 15");
  CHECK(checker.checked() == 3);
}

}  // namespace
}  // namespace sgs
