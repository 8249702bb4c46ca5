// The timed FIFO, the accounts of those who wait for it, and the reader of several.
#include "tlm/timed_fifo.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <vector>

#include "testbench/process/in_child.h"
#include "tests/tlm/threads.h"
#include "tlm/fifo_selector.h"
#include "tlm/phase.h"

namespace sgs {
namespace {

using test::Threads;

const auto settle = [] { sc_core::wait(sc_core::SC_ZERO_TIME); };

// Of one FIFO or more.
struct Reader : sc_core::sc_module {
  FifoIns<int> in{"in"};
  explicit Reader(const sc_core::sc_module_name& name) : sc_module(name) {}
};

TEST_CASE("timed FIFO: an entry is there after the latency and not a cycle sooner") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 4, 3);
  Threads threads({[&] {
                     clock.wait_cycles(5);
                     fifo.push(7, writer);
                   },
                   [&] {
                     clock.wait_cycles(7);
                     settle();
                     CHECK(fifo.fill() == 1);
                     CHECK_FALSE(fifo.can_pop());
                     clock.wait_cycles(1);
                     CHECK(fifo.can_pop());
                     CHECK(fifo.pop(reader) == 7);
                     CHECK(clock.now_cycles() == 8);
                   }});
  CHECK(threads.run_all());
}

TEST_CASE("timed FIFO: a reader waits for input until the entry is ready") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 1, 4);
  Threads threads({[&] {
                     clock.wait_cycles(10);
                     fifo.push(1, writer);
                   },
                   [&] {
                     reader.works();
                     clock.wait_cycles(2);
                     fifo.pop(reader);
                     CHECK(clock.now_cycles() == 14);
                     clock.wait_cycles(3);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.busy_cycles() == 5);
  CHECK(reader.waited_for(WaitFor::kInput) == 12);
  CHECK(reader.waited() == 12);
  REQUIRE(reader.waits().size() == 2);
  CHECK(reader.waits()[1].at == &fifo);
  CHECK(fifo.writer() == &writer);
  CHECK(fifo.reader() == &reader);
}

TEST_CASE("timed FIFO: a reader that waits for a credit waits for room") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 1, 0);
  Threads threads({[&] {
                     clock.wait_cycles(6);
                     fifo.push(1, writer);
                   },
                   [&] {
                     reader.works();
                     fifo.pop(reader, WaitFor::kRoom);
                     CHECK(clock.now_cycles() == 6);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.waited_for(WaitFor::kRoom) == 6);
  CHECK(reader.waited() == 6);
}

TEST_CASE("timed FIFO: a full one holds its writer back, who waits for room") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 2, 1);
  std::vector<int> got;
  Threads threads({[&] {
                     writer.works();
                     fifo.push(1, writer);
                     fifo.push(2, writer);
                     CHECK(clock.now_cycles() == 0);
                     fifo.push(3, writer);
                     CHECK(clock.now_cycles() == 20);
                     writer.close();
                   },
                   [&] {
                     clock.wait_cycles(20);
                     for (int i = 0; i < 3; ++i) got.push_back(fifo.pop(reader));
                     // The third was put in at 20, when the first went.
                     CHECK(clock.now_cycles() == 21);
                   }});
  CHECK(threads.run_all());
  CHECK(got == std::vector<int>{1, 2, 3});
  CHECK(writer.waited_for(WaitFor::kRoom) == 20);
  CHECK(writer.waited() == 20);
  CHECK(fifo.capacity() == 2);
  CHECK(fifo.fill() == 0);
  CHECK(fifo.empty());
}

TEST_CASE("timed FIFO: one entry a cycle flows through a FIFO of one place") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 1, 1);
  Threads threads({[&] {
                     for (int i = 0; i < 100; ++i) fifo.push(i, writer);
                   },
                   [&] {
                     for (int i = 0; i < 100; ++i) CHECK(fifo.pop(reader) == i);
                     CHECK(clock.now_cycles() == 100);
                   }});
  CHECK(threads.run_all());
}

TEST_CASE("timed FIFO: random stalls change times, not what comes out, and are accounted for") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 3, 2);
  fifo.inject({0.3, 7, 3});
  int next = 0;
  Threads threads({[&] {
                     for (int i = 0; i < 1000; ++i) {
                       writer.work(1);
                       fifo.push(i, writer);
                     }
                     writer.idles();
                   },
                   [&] {
                     for (; next < 1000; ++next) CHECK(fifo.pop(reader) == next);
                   }});
  CHECK(threads.run_all());
  CHECK(next == 1000);
  writer.close();
  CHECK(writer.busy_cycles() == 1000);
  CHECK(writer.waited_for(WaitFor::kRoom) > 0);
  CHECK(clock.now_cycles() > 1100);
  CHECK(writer.busy_cycles() + writer.waited() == clock.now_cycles());
}

TEST_CASE("stall injector: as often and as long as it is told") {
  StallInjector stalls({0.25, 10, 1}, "here");
  int stalled = 0;
  std::uint32_t longest = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t cycles = stalls.draw();
    stalled += cycles > 0 ? 1 : 0;
    longest = std::max(longest, cycles);
  }
  CHECK(stalled > 24500);  // 25000, sigma 137
  CHECK(stalled < 25500);
  CHECK(longest == 10);
  StallInjector never({0, 10, 1}, "here");
  for (int i = 0; i < 1000; ++i) CHECK(never.draw() == 0);
}

TEST_CASE("stall injector: each place has a sequence of its own, the same in every run") {
  const auto draws = [](std::uint64_t seed, const std::string& place) {
    StallInjector stalls({0.5, 100, seed}, place);
    std::vector<std::uint32_t> out;
    for (int i = 0; i < 50; ++i) out.push_back(stalls.draw());
    return out;
  };
  CHECK(draws(1, "top.fifo.writer") == draws(1, "top.fifo.writer"));
  CHECK(draws(1, "top.fifo.writer") != draws(1, "top.fifo.reader"));
  CHECK(draws(1, "top.fifo.writer") != draws(2, "top.fifo.writer"));
}

TEST_CASE("activity: every cycle is in one account, by what is waited for and where") {
  const ClockDomain clock(1000);
  Activity activity("unit", clock);
  const TimedFifo<int> full("full", clock, 1), other("other", clock, 1);
  Threads threads({[&] {
    clock.wait_cycles(3);  // idle from the start
    activity.work(5);      // then as before
    clock.wait_cycles(2);
    activity.waits_for(WaitFor::kRoom, full);
    clock.wait_cycles(11);
    activity.work(0);
    activity.waits_for(WaitFor::kRoom, other);
    clock.wait_cycles(1);
    activity.waits_for(WaitFor::kInput, full);
    clock.wait_cycles(4);
    activity.waits_for(WaitFor::kRoom, full);
    clock.wait_cycles(20);
    activity.works();
    clock.wait_cycles(7);
    activity.close();
    CHECK(activity.busy_cycles() == 12);
    CHECK(activity.waited() == 5 + 31 + 1 + 4);
    clock.wait_cycles(1);
    activity.close();  // the state goes on
    CHECK(activity.busy_cycles() == 13);
  }});
  CHECK(threads.run_all());
  struct Row {
    WaitFor what;
    const sc_core::sc_object* at;
    std::uint64_t cycles;
  };
  const std::vector<Row> rows = {{WaitFor::kIdle, nullptr, 5},
                                 {WaitFor::kRoom, &full, 31},
                                 {WaitFor::kRoom, &other, 1},
                                 {WaitFor::kInput, &full, 4}};
  REQUIRE(activity.waits().size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    INFO(name_of(rows[i].what));
    CHECK(activity.waits()[i].what == rows[i].what);
    CHECK(activity.waits()[i].at == rows[i].at);
    CHECK(activity.waits()[i].cycles == rows[i].cycles);
  }
  CHECK(activity.waited_for(WaitFor::kRoom) == 32);
  CHECK(activity.waited_for(WaitFor::kReads) == 0);
}

TEST_CASE("activity: outside its phase all waiting is for that, and work is work") {
  const ClockDomain clock(1000);
  Activity activity("unit", clock), other("other", clock);
  const TimedFifo<int> fifo("fifo", clock, 1);
  Phase phase;
  phase.add(activity);
  Threads threads({[&] {
                     clock.wait_cycles(2);  // idle is idle in any phase
                     activity.waits_for(WaitFor::kInput, fifo);
                     clock.wait_cycles(20);
                     activity.work(3);
                     activity.waits_for(WaitFor::kRoom, fifo);
                     clock.wait_cycles(15);
                     activity.idles();
                     clock.wait_cycles(1);
                     activity.close();
                   },
                   [&] {
                     other.waits_for(WaitFor::kInput, fifo);
                     clock.wait_cycles(10);
                     phase.begin();
                     clock.wait_cycles(20);
                     phase.end();
                     clock.wait_cycles(11);
                     other.close();
                   }});
  CHECK(threads.run_all());
  CHECK(activity.busy_cycles() == 3);
  CHECK(activity.waited_for(WaitFor::kIdle) == 3);
  CHECK(activity.waited_for(WaitFor::kInput) == 12);  // 10 to 22
  CHECK(activity.waited_for(WaitFor::kRoom) == 5);    // 25 to 30
  CHECK(activity.waited_for(WaitFor::kPhase) == 18);  // 2 to 10, 30 to 40
  CHECK(activity.waited() == 38);
  CHECK(other.waited_for(WaitFor::kInput) == 41);
}

TEST_CASE("clock domain: whole cycles, and the next edge from between two") {
  const ClockDomain clock(800);  // 1.25 ns
  Threads threads({[&] {
    clock.wait_cycles(4);
    CHECK(sc_core::sc_time_stamp() == sc_core::sc_time(5, sc_core::SC_NS));
    clock.align();
    CHECK(clock.now_cycles() == 4);
    sc_core::wait(100, sc_core::SC_PS);
    CHECK(clock.now_cycles() == 4);
    clock.align();
    CHECK(clock.now_cycles() == 5);
    CHECK(sc_core::sc_time_stamp() == sc_core::sc_time(6.25, sc_core::SC_NS));
  }});
  CHECK(threads.run_all());
}

TEST_CASE("FIFO selector: in turn while several have entries, and none is forgotten") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> a("a", clock, 100, 1), b("b", clock, 100, 1), c("c", clock, 100, 1);
  Reader inputs("inputs");
  for (TimedFifo<int>* fifo : {&a, &b, &c}) inputs.in(*fifo);
  std::vector<int> turns;
  Threads threads({[&] {
                     for (int i = 0; i < 4; ++i) {
                       a.push(0, writer);
                       c.push(2, writer);
                     }
                     for (int i = 0; i < 2; ++i) b.push(1, writer);
                   },
                   [&] {
                     FifoSelector<int> selector(inputs.in);
                     clock.wait_cycles(5);
                     for (int i = 0; i < 10; ++i) {
                       const int from = selector.select(reader, [](int) { return true; });
                       CHECK(inputs.in[from]->pop(reader) == from);
                       turns.push_back(from);
                     }
                   }});
  CHECK(threads.run_all());
  CHECK(turns == std::vector<int>{1, 2, 0, 1, 2, 0, 2, 0, 2, 0});
}

TEST_CASE("FIFO selector: waits for the first that is wanted, and is charged for that one") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> a("a", clock, 4, 3), b("b", clock, 4, 3);
  Reader inputs("inputs");
  for (TimedFifo<int>* fifo : {&a, &b}) inputs.in(*fifo);
  Threads threads({[&] {
                     a.push(1, writer);
                     clock.wait_cycles(10);
                     b.push(2, writer);
                   },
                   [&] {
                     FifoSelector<int> selector(inputs.in);
                     reader.works();
                     const auto only_b = [](int i) { return i == 1; };
                     CHECK(selector.select(reader, only_b) == 1);
                     CHECK(clock.now_cycles() == 13);
                     CHECK(inputs.in[1]->pop(reader) == 2);
                     CHECK(selector.select(reader, [](int) { return true; }) == 0);
                     CHECK(clock.now_cycles() == 13);
                     inputs.in[0]->pop(reader);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.waited_for(WaitFor::kInput) == 13);
  REQUIRE(reader.waits().size() == 2);
  CHECK(reader.waits()[1].at == &b);
}

TEST_CASE("FIFO selector: waiting is charged to the FIFO whose entry ended it") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> a("a", clock, 4, 2), b("b", clock, 4, 2), c("c", clock, 4, 2);
  Reader inputs("inputs");
  for (TimedFifo<int>* fifo : {&a, &b, &c}) inputs.in(*fifo);
  Threads threads({[&] {
                     clock.wait_cycles(10);
                     c.push(2, writer);
                     clock.wait_cycles(1);
                     a.push(0, writer);
                   },
                   [&] {
                     FifoSelector<int> selector(inputs.in);
                     const auto any = [](int) { return true; };
                     for (const int expected : {2, 0}) {
                       CHECK(selector.select(reader, any) == expected);
                       CHECK(inputs.in[expected]->pop(reader) == expected);
                     }
                     reader.close();
                   }});
  CHECK(threads.run_all());
  std::map<const sc_core::sc_object*, std::uint64_t> waited;
  for (const Activity::Wait& wait : reader.waits()) waited[wait.at] += wait.cycles;
  CHECK(waited[&c] == 12);
  CHECK(waited[&a] == 1);
  CHECK(waited[&b] == 0);
}

// A unit between two FIFOs.
struct Passer : sc_core::sc_module {
  FifoIn<int> in{"in"};
  FifoOut<int> out{"out"};
  explicit Passer(const sc_core::sc_module_name& name) : sc_module(name) {}
};

TEST_CASE("FIFO ports: what is left open, or bound twice, fails elaboration by its name") {
  struct Row {
    const char* what;
    std::vector<int> in, out, reader;  // numbers of the FIFOs that each port is bound to
    std::vector<const char*> message;  // none: elaboration succeeds
  };
  const std::vector<Row> rows = {
      {"an input left open", {}, {1}, {1}, {"port not bound", "unit.in"}},
      {"an output left open", {0}, {}, {0}, {"port not bound", "unit.out"}},
      {"an input of one FIFO or more left open", {0}, {1}, {}, {"port not bound", "reader.in"}},
      {"an input bound to two", {0, 2}, {1}, {1}, {"exceeds maximum of 1", "unit.in"}},
      {"all bound, one to two where that is meant", {0}, {1}, {1, 2}, {}},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    // SystemC elaborates once a process.
    const std::string message = in_child([&] {
      const ClockDomain clock(1000);
      sc_core::sc_vector<TimedFifo<int>> fifos("fifo");
      fifos.init(3,
                 [&](const char* name, std::size_t) { return new TimedFifo<int>(name, clock, 1); });
      Passer unit("unit");
      Reader reader("reader");
      try {
        for (const int k : row.in) unit.in(fifos[static_cast<std::size_t>(k)]);
        for (const int k : row.out) unit.out(fifos[static_cast<std::size_t>(k)]);
        for (const int k : row.reader) reader.in(fifos[static_cast<std::size_t>(k)]);
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
      } catch (const sc_core::sc_report& report) {
        return std::string(report.what());
      }
      return std::string("elaborated");
    });
    if (row.message.empty()) CHECK(message == "elaborated");
    for (const char* part : row.message) CHECK_THAT(message, Catch::Contains(part));
  }
}

}  // namespace
}  // namespace sgs
