// The ledger of a machine written by hand: each way in which work can go unpaid is found and named.
#include "testbench/result/ledger.h"

#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

constexpr std::uint64_t kCycles = 100;

// Two lanes, three comparators, four memories of two ports and one of one.
MachineResult paid() {
  MachineResult machine;
  UnitResult unit;
  unit.name = "adder";
  unit.activities = {{"add", "adding", "adds", 60, {{WaitFor::kInput, "fifo", "", "", 40}}, ""}};
  unit.charged = true;
  machine.units = {unit};
  machine.parts = {{"adder", "fp32_lane", 2, 2}, {"heap", "comparator", 3, 3}};
  machine.operations = {{"adder", "fp32_lane", 200}, {"heap", "comparator", 300}};
  Datapath sum;
  sum.name = "sum";
  sum.used_macs = 1;
  machine.datapaths = {{sum, 100, 100}};
  const SramShape banks{32, SramPorts::kReadAndWrite, 2};
  add(machine.sram_uses, sram_use("rows", "scratch", {{64, "B"}}, banks, {2, 2}), 2);
  add(machine.sram_uses,
      sram_use("table", "scratch", {{64, "B"}}, {32, SramPorts::kOne, 1}, {1, 0}));
  machine.sram_accesses = {{"rows", 400, 400, {2, 2}}, {"table", 60, 40, {0, 0}}};
  return machine;
}

struct Fault {
  const char* what;
  std::function<void(MachineResult&)> plant;
  const char* message;
};

TEST_CASE("ledger: a machine that pays for all has no fault, at full use too") {
  CHECK(ledger_faults(paid(), kCycles).empty());
  for (const LedgerLine& line : ledger_of(paid())) {
    INFO(line.what);
    CHECK(line.utilisation(kCycles) == Approx(1));
  }
}

TEST_CASE("ledger: every kind of unpaid work is found by name") {
  const std::vector<Fault> faults = {
      {"a use without accesses",
       [](MachineResult& m) {
         add(m.sram_uses, sram_use("cache", "scratch", {{8, "B"}}, {32}, kOneOfEach));
       },
       "nobody says the accesses of \"cache\""},
      {"accesses of nothing",
       [](MachineResult& m) {
         m.sram_accesses.push_back({"cache", 0, 0, {0, 0}});
       },
       "\"cache\", which is no use"},
      {"two uses of a name",
       [](MachineResult& m) {
         add(m.sram_uses, sram_use("rows", "scratch", {{8, "B"}}, {32}, kOneOfEach));
       },
       "two different uses of on-chip memory are named \"rows\""},
      {"operations of no part",
       [](MachineResult& m) {
         m.operations.push_back({"x", "lane", 1});
       },
       "x: lane: 1 done, and nothing stands there"},
      {"operations of another component's part",
       [](MachineResult& m) {
         m.operations.push_back({"heap", "fp32_lane", 1});
       },
       "heap: fp32_lane: 1 done"},
      {"too many operations", [](MachineResult& m) { m.operations[1].count += 1; },
       "heap: comparator: 301 done, 3 a cycle"},
      {"one datapath busier than the frame is long",
       [](MachineResult& m) { m.datapaths[0].busiest_cycles += 1; },
       "sum: busiest: 101 done, 1 a cycle"},
      {"too many reads", [](MachineResult& m) { m.sram_accesses[0].reads += 1; },
       "rows: reads: 401 done, 4 a cycle"},
      {"too many writes", [](MachineResult& m) { m.sram_accesses[0].writes += 1; },
       "rows: writes: 401 done"},
      {"too many accesses of one port", [](MachineResult& m) { m.sram_accesses[1].reads += 1; },
       "table: accesses: 101 done, 1 a cycle"},
      {"more reads in a cycle than ports", [](MachineResult& m) { m.sram_uses[0].peak.reads = 3; },
       "rows: 3 reads and 2 writes in a cycle, 2 banks of a port for each"},
      {"more writes", [](MachineResult& m) { m.sram_uses[0].peak.writes = 3; },
       "rows: 2 reads and 3 writes in a cycle"},
      {"a read and a write of one port", [](MachineResult& m) { m.sram_uses[1].peak.writes = 1; },
       "table: 1 reads and 1 writes in a cycle, 1 banks of a port"},
      {"a queue that takes more than is said",
       [](MachineResult& m) { m.sram_accesses[0].seen.writes = 3; },
       "rows: 2 reads and 3 writes seen in a cycle, 2 and 2 are said"},
      {"a queue that gives more", [](MachineResult& m) { m.sram_accesses[0].seen.reads = 3; },
       "rows: 3 reads and 2 writes seen"},
      {"banks of half a word", [](MachineResult& m) { m.sram_uses[0].shape.width_bits = 257; },
       "rows: 64 B in 2 banks of 257 bits: a bank does not hold a word"},
      {"a busy unit that charges nothing", [](MachineResult& m) { m.units[0].charged = false; },
       "adder was busy for 60 cycles and charged nothing"}};
  for (const Fault& fault : faults) {
    INFO(fault.what);
    MachineResult machine = paid();
    fault.plant(machine);
    const std::vector<std::string> found = ledger_faults(machine, kCycles);
    REQUIRE(found.size() >= 1);
    bool named = false;
    for (const std::string& text : found) {
      INFO(text);
      named = named || text.find(fault.message) != std::string::npos;
    }
    CHECK(named);
  }
}

TEST_CASE("ledger: what was idle needs to have charged nothing") {
  MachineResult machine = paid();
  machine.units[0].charged = false;
  machine.units[0].activities[0].busy_cycles = 0;
  CHECK(ledger_faults(machine, kCycles).empty());
}

}  // namespace
}  // namespace sgs::test
