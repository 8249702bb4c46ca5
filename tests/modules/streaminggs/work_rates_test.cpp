// Turns at lanes that work by a fixed schedule.
#include "modules/datapath/work_rates.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/folded_pipeline.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs::test {

TEST_CASE("turns: what one lane-set begins, begins whole intervals apart") {
  std::mt19937 random(1);
  for (const std::uint64_t interval : {1U, 2U, 7U, 39U}) {
    for (const std::uint64_t copies : {1U, 2U, 4U, 7U}) {
      if (copies > interval) continue;
      INFO(copies << " copies, a turn every " << interval << " cycles");
      std::map<std::uint64_t, std::uint64_t> last;  // [place in the interval]
      std::uint64_t now = 0;
      for (int item = 0; item < 1000; ++item) {
        const std::uint64_t begins = next_turn_of_one(now, interval, copies);
        CHECK(begins >= now);
        CHECK(begins < now + interval);
        const std::uint64_t copy = begins % interval;
        CHECK(copy < copies);
        if (last.count(copy) > 0) {
          CHECK(begins > last[copy]);
          CHECK((begins - last[copy]) % interval == 0);
        }
        last[copy] = begins;
        if (copies == 1) CHECK(begins == next_turn(now, interval));
        now = begins + 1 + random() % 3 * (random() % 20);
      }
    }
  }
}

TEST_CASE("turns: spread evenly, of each lane-set whole intervals apart") {
  for (const std::uint64_t interval : {1U, 2U, 7U, 27U}) {
    for (const std::uint64_t copies : {1U, 2U, 4U, 9U}) {
      INFO(copies << " copies, a turn every " << interval << " cycles");
      const std::uint64_t used = std::min(copies, interval);
      std::vector<std::uint64_t> turns;
      for (std::uint64_t now = 0; now < 3 * interval; ++now) {
        const std::uint64_t begins = next_spread_turn(now, interval, copies);
        CHECK(begins >= now);
        if (begins == now) turns.push_back(now);
      }
      REQUIRE(turns.size() == 3 * used);
      for (std::size_t i = 1; i < turns.size(); ++i) {
        CHECK(turns[i] - turns[i - 1] >= interval / used);
        if (i >= used) CHECK(turns[i] - turns[i - used] == interval);
      }
    }
  }
}

// In a cycle of the interval each item under way takes what its own kind takes there: the worst is
// the larger of the two kinds for each item.
TEST_CASE("turns: steps of rays out of blocks and out of cells meet on no lane") {
  constexpr OperationLatencies latencies{3, 1, 1};
  for (const std::uint32_t lanes : {24U, 30U, 48U}) {
    INFO(lanes << " lanes");
    PaperVsuConfig config;
    config.step_lanes = lanes;
    const Datapath block = ray_step_pipeline(config, latencies);
    REQUIRE(block.interval_cycles() == 1);
    CHECK(cell_step_pipeline(config, latencies).depth_cycles < block.depth_cycles);
    const FoldedParts parts = parts_of(block, 1);
    // [part, cycle of an item]: by an item of each kind
    std::map<std::tuple<StepBy, std::uint32_t>, std::array<std::uint32_t, 2>> taken;
    int kind = 0;
    for (const StepCase& step : {longest_step_case(), cell_step_case()}) {
      const auto steps = ray_step_flow(step).steps(latencies);
      const FoldedSchedule schedule = folded_pipeline(steps, parts, latencies).schedule;
      for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].by != StepBy::kOutside) ++taken[{steps[i].by, schedule.begins[i]}][kind];
      }
      ++kind;
    }
    std::map<StepBy, std::uint32_t> most;
    for (const auto& [of, by_kind] : taken) {
      most[std::get<StepBy>(of)] += std::max(by_kind[0], by_kind[1]);
    }
    for (const auto& [by, count] : most) CHECK(count <= parts.of(by));
  }
  for (const std::uint32_t lanes : {1U, 4U, 8U, 12U, 23U}) {
    INFO(lanes << " lanes");
    PaperVsuConfig config;
    config.step_lanes = lanes;
    CHECK(cell_step_pipeline(config, latencies).depth_cycles ==
          ray_step_pipeline(config, latencies).depth_cycles);
  }
}

}  // namespace sgs::test
