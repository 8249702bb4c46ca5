// Activities that wait for a memory port, in their own clock.
#include "tlm/memory_access.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "tests/tlm/scripted_ends.h"
#include "tests/tlm/unit_with_port.h"

namespace sgs {
namespace {

using test::Unit;

TEST_CASE("memory access: whatever held an activity up, it goes on at an edge of its clock") {
  // A request ends, and is answered, 30 ns after the one before: no multiple of the clock's 7 ns.
  const ClockDomain clock(1000.0 / 7);
  Activity activity("activity", clock);
  std::vector<std::uint64_t> cycles;
  std::uint8_t byte = 0;
  const auto now = [&] {
    const sc_core::sc_time stamp = sc_core::sc_time_stamp();
    CHECK(stamp == static_cast<double>(clock.now_cycles()) * clock.period());
    cycles.push_back(clock.now_cycles());
  };
  Unit unit("unit", MemoryPortConfig{}, {[&](MemoryPort& port) {
              start_write(port, activity, 0, &byte, 1, 0);  // ends at 0
              now();
              start_write(port, activity, 0, &byte, 1, 0);  // at 30: in cycle 5
              now();
              start_read(port, activity, 0, &byte, 1, 0);  // at 35 or 60: in cycle 9
              now();
              const MemoryPort::Ticket ticket =
                  start_read(port, activity, 0, &byte, 1, 0);  // at 90
              now();
              await(port, activity, ticket);  // answered at 120: in cycle 18
              now();
              start_read(port, activity, 0, &byte, 1, 0);
              now();
              await_all(port, activity);  // asked for in cycle 18, at 126: answered at 156
              now();
              clock.wait_cycles(2);
              activity.close();
            }});
  test::ScriptedTarget target("target", test::Answers::kCompletedLater);
  unit.port.socket.bind(target.socket);
  sc_core::sc_start();
  CHECK(unit.finished == 1);
  CHECK(cycles == std::vector<std::uint64_t>{0, 5, 9, 13, 18, 18, 23});
  CHECK(activity.waited_for(WaitFor::kPort) == 13);
  CHECK(activity.waited_for(WaitFor::kReads) == 5 + 5);
  CHECK(activity.busy_cycles() == 2);
}

}  // namespace
}  // namespace sgs
