// The accounts of what works and waits, and the clock that they are kept by.
#include "tlm/activity.h"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/tlm/threads.h"
#include "tlm/phase.h"
#include "tlm/timed_fifo.h"

namespace sgs {
namespace {

using test::Threads;

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

}  // namespace
}  // namespace sgs
