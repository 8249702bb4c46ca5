// "This sub-tile is finished" travels: seen when its latency has passed and not a cycle sooner.
#include "modules/streaminggs/finished_subtiles.h"

#include <catch2/catch.hpp>

#include "tests/tlm/threads.h"

namespace sgs {
namespace {

using test::Threads;

TEST_CASE("finished sub-tiles: a reach is open until the last of its sub-tiles is seen") {
  const ClockDomain clock(800);
  // 3 columns and 2 rows, the last ones cut; a second group of one sub-tile.
  FinishedSubtiles mask("mask", clock, {{0, 0, 10, 6}, {12, 0, 14, 3}}, 5);
  struct Row {
    GroupReach reach;
    std::uint64_t open_until;  // cycle
  };
  // Sub-tile 1 is seen from cycle 8 on, sub-tile 4, below it, from 20 on.
  constexpr std::uint64_t kEver = 1000;
  const Row rows[] = {{{1, 0, 1, 0}, 8},     {{1, 1, 1, 1}, 20},    {{1, 0, 1, 1}, 20},
                      {{0, 0, 1, 0}, kEver}, {{1, 0, 2, 0}, kEver}, {{}, kEver}};
  Threads threads({[&] {
                     mask.finish(0, 1, 3);
                     clock.wait_cycles(15);
                     mask.finish(0, 4, 0);
                   },
                   [&] {
                     for (std::uint64_t cycle = 0; cycle < 40; ++cycle) {
                       for (int delta = 0; delta < 2; ++delta) {
                         for (const Row& row : rows) {
                           INFO("cycle " << cycle);
                           CHECK(mask.any_unfinished(0, row.reach) == (cycle < row.open_until));
                         }
                         CHECK(mask.any_unfinished(1, {}));
                         sc_core::wait(sc_core::SC_ZERO_TIME);
                       }
                       clock.wait_cycles(1);
                     }
                   }});
  CHECK(threads.run_all());
  CHECK(mask.news() == 2);
}

TEST_CASE("finished sub-tiles: a reach beyond the group's edge is cut to the group") {
  const ClockDomain clock(1000);
  FinishedSubtiles mask("mask", clock, {{0, 0, 4, 8}}, 1);
  Threads threads({[&] {
    mask.finish(0, 0, 0);
    mask.finish(0, 1, 0);
    clock.wait_cycles(1);
    CHECK_FALSE(mask.any_unfinished(0, {}));
    CHECK_FALSE(mask.any_unfinished(0, {0, 1, 200, 200}));
  }});
  CHECK(threads.run_all());
}

}  // namespace
}  // namespace sgs
