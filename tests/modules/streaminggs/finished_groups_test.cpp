// "This group is finished" travels: seen when its latency has passed and not a cycle sooner.
#include "modules/streaminggs/finished_groups.h"

#include <catch2/catch.hpp>

#include "tests/tlm/threads.h"

namespace sgs {
namespace {

using test::Threads;

// Asks through a port, as units do.
struct Asker : sc_core::sc_module {
  FinishedGroupsIn finished{"finished"};
  FinishGroupOut finish{"finish"};
  explicit Asker(const sc_core::sc_module_name& name) : sc_module(name) {}
};

TEST_CASE("finished groups: both ends are ports, and a group said twice in a cycle is one") {
  const ClockDomain clock(1000);
  FinishedGroups groups("groups", clock, 1, 2);
  Asker unit("unit");
  unit.finished(groups);
  unit.finish(groups);
  Threads threads({[&] {
    unit.finish->finish(0, 0);
    unit.finish->finish(0, 0);
    clock.wait_cycles(1);
    CHECK_FALSE(unit.finished->finished(0));
    clock.wait_cycles(1);
    CHECK(unit.finished->finished(0));
  }});
  CHECK(threads.run_all());
}

}  // namespace
}  // namespace sgs
