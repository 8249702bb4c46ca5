// "This group is finished" travels: seen when its latency has passed and not a cycle sooner.
#include "modules/streaminggs/finished_groups.h"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/tlm/threads.h"

namespace sgs {
namespace {

using test::Threads;

TEST_CASE("finished groups: seen at the latency, not a cycle sooner, each group by itself") {
  const ClockDomain clock(800);  // 1.25 ns
  struct Row {
    std::uint32_t latency_cycles;
    std::uint64_t finished_in_cycle;
    std::uint32_t known_in_cycles;
  };
  const std::vector<Row> rows = {{1, 0, 0}, {1, 7, 0}, {2, 7, 3}, {5, 0, 1}, {40, 13, 4}};
  sc_core::sc_vector<FinishedGroups> channels("finished");
  channels.init(rows.size(), [&](const char* name, std::size_t k) {
    return new FinishedGroups(name, clock, 3, rows[k].latency_cycles);
  });
  std::vector<std::function<void()>> bodies;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    FinishedGroups& groups = channels[k];
    const Row& row = rows[k];
    bodies.emplace_back([&] {
      clock.wait_cycles(row.finished_in_cycle);
      groups.finish(1, row.known_in_cycles);
      CHECK_FALSE(groups.finished(1));
      // Said again, it stays as early as it was.
      clock.wait_cycles(1);
      groups.finish(1, row.known_in_cycles);
    });
    bodies.emplace_back([&] {
      for (std::uint64_t cycle = 0; cycle < 60; ++cycle) {
        // However many times the kernel comes round in this instant.
        for (int delta = 0; delta < 3; ++delta) {
          INFO("latency " << row.latency_cycles << ", cycle " << cycle);
          const std::uint64_t seen_from =
              row.finished_in_cycle + row.known_in_cycles + row.latency_cycles;
          CHECK(groups.finished(1) == (cycle >= seen_from));
          CHECK_FALSE(groups.finished(0));
          CHECK_FALSE(groups.finished(2));
          sc_core::wait(sc_core::SC_ZERO_TIME);
        }
        clock.wait_cycles(1);
      }
    });
  }
  Threads threads(std::move(bodies));
  CHECK(threads.run_all());
}

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
