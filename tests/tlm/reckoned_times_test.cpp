// FIFOs and shared resources without a kernel: what estimates reckon with.
#include <catch2/catch.hpp>
#include <cstdint>

#include "tlm/booked_time.h"
#include "tlm/fifo_times.h"

namespace sgs::test {
namespace {

TEST_CASE("fifo times: an entry waits for room, and its reader for the latency") {
  FifoTimes fifo(2, 3);
  CHECK(fifo.push(10) == 10);
  CHECK(fifo.push(11) == 11);
  CHECK(fifo.pop(0) == 13);    // there from cycle 13 on
  CHECK(fifo.push(12) == 13);  // in the place of the first
  CHECK(fifo.front(20) == 20);
  fifo.remove(25);
  CHECK(fifo.push(14) == 25);
  CHECK(fifo.pop(0) == 16);
  CHECK(fifo.pushed() == 4);
}

TEST_CASE("fifo times: a place that is held is free when an entry in it would be ready") {
  FifoTimes fifo(2, 3);
  CHECK(fifo.room(10) == 10);
  fifo.hold_place(10);  // until cycle 13
  CHECK(fifo.room(11) == 11);
  CHECK(fifo.push(11) == 11);
  CHECK(fifo.pop(20) == 20);   // of the entry's place
  CHECK(fifo.room(12) == 13);  // that of the held one is free before
  fifo.hold_place(13);         // until 16
  CHECK(fifo.room(14) == 16);
  CHECK(fifo.room(20) == 20);
  fifo.hold_place(20);
  fifo.hold_place(21);
  CHECK(fifo.room(22) == 23);  // both are held
  CHECK(fifo.push(23) == 23);
  CHECK(fifo.pushed() == 2);
}

TEST_CASE("booked time: who comes first is served first, in whatever order they ask") {
  BookedTime bus(16);
  CHECK(bus.book(32, 8) == 40);
  CHECK(bus.book(32, 8) == 48);
  CHECK(bus.book(0, 8) == 8);    // long before: it does not wait
  CHECK(bus.book(48, 4) == 52);  // the third window's work is done
  CHECK(bus.book(0, 40) == 48);  // five windows' worth at once, from behind the 8 of its window
  CHECK(bus.book(20, 1) == 49);  // waits for what is left of that
  CHECK(bus.busy_cycles() == 69);
}

}  // namespace
}  // namespace sgs::test
