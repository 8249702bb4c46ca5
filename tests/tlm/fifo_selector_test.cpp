// The reader of several FIFOs.
#include "tlm/fifo_selector.h"

#include <catch2/catch.hpp>
#include <map>
#include <vector>

#include "tests/tlm/fifo_reader.h"
#include "tests/tlm/threads.h"

namespace sgs {
namespace {

using test::FifoReader;
using test::Threads;

TEST_CASE("FIFO selector: in turn while several have entries, and none is forgotten") {
  const ClockDomain clock(1000);
  Activity writer("writer", clock), reader("reader", clock);
  TimedFifo<int> a("a", clock, 100, 1), b("b", clock, 100, 1), c("c", clock, 100, 1);
  FifoReader inputs("inputs");
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
  FifoReader inputs("inputs");
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
  FifoReader inputs("inputs");
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

}  // namespace
}  // namespace sgs
