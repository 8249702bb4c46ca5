// The timed FIFO: when entries are there, and who waits for them.
#include "tlm/timed_fifo.h"

#include <catch2/catch.hpp>

#include "tests/tlm/threads.h"

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

}  // namespace
}  // namespace sgs
