// The timed FIFO, the accounts of those who wait for it, and the reader of several.
#include "tlm/timed_fifo.h"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/tlm/threads.h"
#include "tlm/fifo_selector.h"

namespace sgs {
namespace {

using test::Threads;

const auto settle = [] { sc_core::wait(sc_core::SC_ZERO_TIME); };

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

TEST_CASE("timed FIFO: a reader that waits is starved until the entry is ready") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 1, 4);
  Threads threads({[&] {
                     clock.wait_cycles(10);
                     fifo.push(1, writer);
                   },
                   [&] {
                     reader.enter(ActivityState::kBusy);
                     clock.wait_cycles(2);
                     fifo.pop(reader);
                     CHECK(clock.now_cycles() == 14);
                     clock.wait_cycles(3);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.busy_cycles() == 5);
  CHECK(reader.starved_cycles() == 12);
  CHECK(reader.blocked_cycles() == 0);
}

TEST_CASE("timed FIFO: a reader that waits for a credit is blocked") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 1, 0);
  Threads threads({[&] {
                     clock.wait_cycles(6);
                     fifo.push(1, writer);
                   },
                   [&] {
                     reader.enter(ActivityState::kBusy);
                     fifo.pop(reader, ActivityState::kBlocked);
                     CHECK(clock.now_cycles() == 6);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.blocked_cycles() == 6);
  CHECK(reader.starved_cycles() == 0);
}

TEST_CASE("timed FIFO: a full one holds its writer back, who is blocked meanwhile") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> fifo("fifo", clock, 2, 1);
  std::vector<int> got;
  Threads threads({[&] {
                     writer.enter(ActivityState::kBusy);
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
  CHECK(writer.blocked_cycles() == 20);
  CHECK(writer.starved_cycles() == 0);
  CHECK(fifo.max_fill() == 2);
  CHECK(fifo.pushed() == 3);
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
  StallInjector stalls(3, 0.3, 7);
  TimedFifo<int> fifo("fifo", clock, 3, 2);
  fifo.inject(&stalls);
  int next = 0;
  Threads threads({[&] {
                     for (int i = 0; i < 1000; ++i) {
                       writer.work(1);
                       fifo.push(i, writer);
                     }
                     writer.enter(ActivityState::kStarved);
                   },
                   [&] {
                     for (; next < 1000; ++next) CHECK(fifo.pop(reader) == next);
                   }});
  CHECK(threads.run_all());
  CHECK(next == 1000);
  writer.close();
  CHECK(writer.busy_cycles() == 1000);
  CHECK(writer.blocked_cycles() > 0);
  CHECK(clock.now_cycles() > 1100);
  CHECK(writer.busy_cycles() + writer.blocked_cycles() + writer.starved_cycles() ==
        clock.now_cycles());
}

TEST_CASE("stall injector: as often and as long as it is told") {
  StallInjector stalls(1, 0.25, 10);
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
  StallInjector never(1, 0, 10);
  for (int i = 0; i < 1000; ++i) CHECK(never.draw() == 0);
}

TEST_CASE("activity: every cycle is in one of three accounts") {
  const ClockDomain clock(1000);
  Activity activity("unit", clock);
  Threads threads({[&] {
    clock.wait_cycles(3);  // starved from the start
    activity.work(5);      // then as before
    clock.wait_cycles(2);
    activity.enter(ActivityState::kBlocked);
    clock.wait_cycles(11);
    activity.work(0);
    activity.enter(ActivityState::kBusy);
    clock.wait_cycles(7);
    activity.close();
    CHECK(activity.busy_cycles() == 12);
    CHECK(activity.starved_cycles() == 5);
    CHECK(activity.blocked_cycles() == 11);
    clock.wait_cycles(1);
    activity.close();  // the state goes on
    CHECK(activity.busy_cycles() == 13);
  }});
  CHECK(threads.run_all());
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
  FifoSelector<int> selector({&a, &b, &c});
  std::vector<std::size_t> turns;
  Threads threads({[&] {
                     for (int i = 0; i < 4; ++i) {
                       a.push(0, writer);
                       c.push(2, writer);
                     }
                     for (int i = 0; i < 2; ++i) b.push(1, writer);
                   },
                   [&] {
                     clock.wait_cycles(5);
                     for (int i = 0; i < 10; ++i) {
                       const std::size_t from =
                           selector.select(reader, [](std::size_t) { return true; });
                       CHECK(selector.fifo(from).pop(reader) == static_cast<int>(from));
                       turns.push_back(from);
                     }
                   }});
  CHECK(threads.run_all());
  CHECK(turns == std::vector<std::size_t>{1, 2, 0, 1, 2, 0, 2, 0, 2, 0});
}

TEST_CASE("FIFO selector: waits for the first that is wanted, and is starved meanwhile") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> a("a", clock, 4, 3), b("b", clock, 4, 3);
  FifoSelector<int> selector({&a, &b});
  Threads threads({[&] {
                     a.push(1, writer);
                     clock.wait_cycles(10);
                     b.push(2, writer);
                   },
                   [&] {
                     reader.enter(ActivityState::kBusy);
                     const auto only_b = [](std::size_t i) { return i == 1; };
                     CHECK(selector.select(reader, only_b) == 1);
                     CHECK(clock.now_cycles() == 13);
                     CHECK(selector.fifo(1).pop(reader) == 2);
                     CHECK(selector.select(reader, [](std::size_t) { return true; }) == 0);
                     CHECK(clock.now_cycles() == 13);
                     selector.fifo(0).pop(reader);
                     reader.close();
                   }});
  CHECK(threads.run_all());
  CHECK(reader.starved_cycles() == 13);
}

}  // namespace
}  // namespace sgs
