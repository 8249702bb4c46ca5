// Schedules of the machine's own computations, checked against what a schedule must be.
#include "modules/datapath/folded_schedule.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/splat/counting.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/filter_flows.h"
#include "modules/datapath/folded_pipeline.h"
#include "modules/datapath/lane_steps.h"
#include "modules/datapath/rendering_flows.h"
#include "tests/modules/datapath/flow_parts.h"

namespace sgs::test {
namespace {

struct Work {
  Work(std::string of, const FlowPart& flow)
      : what(std::move(of)),
        steps(flow.steps(kLatencies)),
        counts(flow.counts()),
        path(flow.longest_path(kLatencies)) {}
  std::string what;
  std::vector<LaneStep> steps;
  OperationCounts counts;
  LongestPath path;
};

std::vector<Work> all_work() {
  std::vector<Work> all;
  for (const CoarseBoundBy by : {CoarseBoundBy::kExtents, CoarseBoundBy::kLargestScale}) {
    all.emplace_back("coarse", coarse_flow(by, longest_case(), 2));
  }
  for (const FineRecord record :
       {FineRecord{0, 4}, FineRecord{0, 3}, FineRecord{2, 3}, FineRecord{3, 4}}) {
    all.emplace_back("fine", fine_flow(longest_case(), record).all);
  }
  const RenderingFlows flows = rendering_flows(BlendPrecision::kSingle);
  all.emplace_back("beginning", flows.spans_begin);
  all.emplace_back("span", flows.span);
  all.emplace_back("conic", flows.conic);
  all.emplace_back("blend", flows.subtile_blend);
  all.emplace_back("blend in half", rendering_flows(BlendPrecision::kHalf).subtile_blend);
  return all;
}

std::vector<LaneStep> steps_of(const DataFlow& flow,
                               std::vector<std::vector<std::uint32_t>> together = {}) {
  return part_of(flow, 0, flow.size(), std::move(together)).steps(kLatencies);
}

std::map<StepBy, std::uint32_t> by_part(const std::vector<LaneStep>& steps) {
  std::map<StepBy, std::uint32_t> count;
  for (const LaneStep& step : steps) ++count[step.by];
  return count;
}

// What every schedule is: no step before its sources, no part twice in a cycle of the interval.
void check_schedule(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                    const FoldedSchedule& schedule) {
  std::map<std::pair<StepBy, std::uint32_t>, std::uint32_t> busy;
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::uint32_t begin = schedule.begins[i];
    for (const LaneStep::Source& source : steps[i].sources) {
      if (source.value.is_constant) continue;
      const std::uint32_t from = source.value.of;
      REQUIRE(from < i);
      // A value from outside is read before it comes, once the answers are there.
      const std::uint32_t read =
          steps[i].by == StepBy::kOutside ? latency_of(steps[i], kLatencies) : 0;
      CHECK(schedule.begins[from] + cycles_of(steps[from].by, kLatencies) + read <= begin);
    }
    end = std::max(end, begin + cycles_of(steps[i].by, kLatencies));
    const StepBy by = part_kind(steps[i].by);
    if (steps[i].by == StepBy::kSum) {
      const std::uint32_t product = steps[i].sources.front().value.of;
      CHECK(begin == schedule.begins[product] + kLatencies.product());
    }
    if (by == StepBy::kOutside) continue;
    CHECK(++busy[{by, begin % parts.interval_cycles}] <= parts.of(by));
  }
  CHECK(schedule.cycles == end);
}

}  // namespace

TEST_CASE("lane steps: as many as are counted") {
  for (const Work& work : all_work()) {
    INFO(work.what);
    auto count = by_part(work.steps);
    CHECK(count[StepBy::kLane] + count[StepBy::kProduct] == folded_macs(work.counts));
    CHECK(count[StepBy::kComparator] == comparisons(work.counts));
    CHECK(count[StepBy::kTable] == seeds(work.counts) + work.counts.look_ups);
  }
}

TEST_CASE("folded schedule: of the path and no longer with parts for every step") {
  for (const Work& work : all_work()) {
    INFO(work.what);
    const FoldedParts parts = at_least({1, 1, 1, 1}, work.steps);
    const FoldedSchedule schedule = folded_schedule(work.steps, parts, kLatencies);
    check_schedule(work.steps, parts, schedule);
    CHECK(schedule.cycles == work.path.cycles(kLatencies));
  }
}

TEST_CASE("folded schedule: on few lanes no part works twice at once, and it takes longer") {
  for (const Work& work : all_work()) {
    for (const std::uint32_t lanes : {1U, 4U, 16U, 60U}) {
      INFO(work.what << " on " << lanes << " lanes");
      FoldedParts parts;
      parts.lanes = lanes;
      parts.interval_cycles = (folded_macs(work.counts) + lanes - 1) / lanes;
      parts = at_least(parts, work.steps);
      CHECK(parts.lanes == lanes);
      FoldedPipeline folded = folded_pipeline(work.steps, parts, kLatencies);
      check_schedule(work.steps, parts, folded.schedule);
      CHECK(folded.schedule.cycles >= work.path.cycles(kLatencies));
      // The last turn of the interval begins no sooner than the lanes have done the others.
      CHECK(folded.schedule.cycles >= folded_macs(work.counts) / lanes);
      const std::uint32_t alive =
          most_alive(work.steps, folded.schedule, parts.interval_cycles, kLatencies);
      CHECK(folded.wiring.register_words >= alive);
      CHECK(folded.wiring.register_words <= folded.wiring.words_written);
      CHECK(folded.wiring.register_words <= alive + alive / 10 + 1);
      // Each source of a step and each write passes a part of a multiplexer at most.
      std::size_t taken = folded.wiring.words_written;
      for (const LaneStep& step : work.steps) taken += step.sources.size();
      CHECK(folded.wiring.select_words < taken);
    }
  }
}

TEST_CASE("folded schedule: lives are no longer for being moved, and the end is no later") {
  for (const Work& work : all_work()) {
    INFO(work.what);
    FoldedParts parts;
    parts.lanes = 16;
    parts.interval_cycles = (folded_macs(work.counts) + 15) / 16;
    parts = at_least(parts, work.steps);
    FoldedSchedule schedule = folded_schedule(work.steps, parts, kLatencies);
    const auto words = [&] {
      return lane_wiring(work.steps, schedule, parts, kLatencies).words_written;
    };
    const std::uint32_t cycles = schedule.cycles, before = words();
    shorten_lives(work.steps, parts, kLatencies, schedule);
    check_schedule(work.steps, parts, schedule);
    CHECK(schedule.cycles <= cycles);
    CHECK(words() <= before);
  }
}

TEST_CASE("folded schedule: as many parts of a kind stand there as begin in a cycle") {
  bool one_cycle_takes_more = false;
  for (const Work& work : all_work()) {
    INFO(work.what);
    Datapath path = counted_datapath("work", "work", work.counts);
    path.lanes = 4;
    const auto at_full_rate = [&](std::uint32_t operations) {
      return (operations * path.lanes + path.used_macs - 1) / path.used_macs;
    };
    schedule(path, work.steps, kLatencies);
    const auto interval = static_cast<std::uint32_t>(path.interval_cycles());
    const FoldedPipeline folded = folded_pipeline(work.steps, parts_of(path, interval), kLatencies);
    std::map<std::string, std::map<std::uint32_t, std::uint32_t>> begun;  // [kind][cycle]
    std::map<std::string, std::uint32_t> operations;
    for (std::size_t i = 0; i < work.steps.size(); ++i) {
      for (const BesideLanes& part : path.beside) {
        const BesideLane begins = work.steps[i].begins;
        if (begins == BesideLane::kNone || !does(part, begins)) continue;
        ++operations[part.kind];
        ++begun[part.kind][folded.schedule.begins[i] % interval];
      }
    }
    for (const BesideLanes& part : path.beside) {
      INFO(part.kind);
      CHECK(operations[part.kind] == part.operations);
      std::uint32_t most = 0;
      for (const auto& [cycle, count] : begun[part.kind]) most = std::max(most, count);
      CHECK(path.parts(part) == std::max(most, at_full_rate(part.operations)));
      one_cycle_takes_more |= most > at_full_rate(part.operations);
    }
  }
  CHECK(one_cycle_takes_more);
}

TEST_CASE("folded schedule: too few parts are refused") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  static_cast<void>(a * b * c);
  const auto steps = steps_of(flow);
  CHECK_THROWS_AS(folded_schedule(steps, {1, 0, 0, 1}, kLatencies), std::logic_error);
  CHECK(folded_schedule(steps, {1, 0, 0, 2}, kLatencies).cycles == 5);  // the second waits a turn
  CHECK(folded_schedule(steps, {1, 0, 0, 3}, kLatencies).cycles == 4);
  CHECK(folded_schedule(steps, {2, 0, 0, 1}, kLatencies).cycles == 4);
}

TEST_CASE("folded schedule: what is read when it is needed makes a loop") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3);
  const Counting weight = sqrt(a) * b;  // some 22 cycles
  const std::uint32_t first = static_cast<std::uint32_t>(flow.size());
  const Counting state = input(flow, 5);
  static_cast<void>(state - weight * state < Counting(1.0F));
  const auto steps = steps_of(flow, {{first}});
  const FoldedParts parts = at_least({1, 1, 1, 1}, steps);
  const FoldedSchedule schedule = folded_schedule(steps, parts, kLatencies);
  REQUIRE(schedule.loops.size() == 1);
  const DatapathLoop loop = schedule.loops.front();
  CHECK(loop.cycles() == longest_loop(steps, kLatencies).cycles(kLatencies));
  CHECK(loop.cycles() < schedule.cycles);
  CHECK(loop.end == schedule.cycles);
}

TEST_CASE("folded schedule: every pixel waits for both comparisons of its alpha") {
  for (const BlendPrecision precision : {BlendPrecision::kSingle, BlendPrecision::kHalf}) {
    const auto steps = rendering_flows(precision).subtile_blend.steps(kLatencies);
    std::map<std::uint32_t, std::uint32_t> numbers;  // [list]
    for (const LaneStep& step : steps) {
      if (step.comes_with == 0) continue;
      ++numbers[step.comes_with];
      CHECK(step.sources.size() == 2);
      for (const LaneStep::Source& answer : step.sources) CHECK(steps[answer.value.of].answers);
    }
    CHECK(numbers.size() == 16);
    for (const auto& [list, count] : numbers) CHECK(count == 4);
  }
}

TEST_CASE("pixel writes: with one port a result waits where its place is read") {
  Datapath blend;
  blend.lanes = 1;
  blend.used_macs = 3;  // a blend every third cycle
  blend.depth_cycles = 20;
  // Read in cycles 9, 9 and 11 and every third; results in 17, and in 18 and 20, which are reads.
  blend.loops = {{10, 17}, {10, 18}, {12, 20}};
  const PixelWrites two = pixel_writes(blend, SramPorts::kReadAndWrite);
  CHECK((two.loop_cycles == 8 && two.wait_cycles == 0 && two.held == 0));
  const PixelWrites one = pixel_writes(blend, SramPorts::kOne);
  CHECK((one.loop_cycles == 9 && one.wait_cycles == 1 && one.held == 1));
  blend.depth_cycles = 21;  // the schedule holds the last as long
  CHECK(pixel_writes(blend, SramPorts::kOne).held == 0);
}

TEST_CASE("lane wiring: registers and multiplexers by hand") {
  struct Row {
    const char* what;
    FoldedParts parts;
    Counting (*of)(Counting a, Counting b, Counting c);
    LaneWiring expected;  // words of registers, of multiplexers; written, selected
  };
  const Row rows[] = {
      // Two inputs, a cycle each; the product stays in the lane.
      {"a product on its lane",
       {1, 0, 0, 1},
       [](Counting a, Counting b, Counting) { return a * b; },
       {2, 0, 2, 0}},
      // c waits for 2 cycles: a register each, for an item comes each cycle.
      {"a factor that waits",
       {2, 0, 0, 1},
       [](Counting a, Counting b, Counting c) { return a * b * c; },
       {2 + 3, 0, 5, 0}},
      // c waits in two registers; a and the product, a cycle between its turns, share one, which
      // takes now this, now that. The lane takes b or c.
      {"the same on one lane",
       {1, 0, 0, 2},
       [](Counting a, Counting b, Counting c) { return a * b * c; },
       {4, 2, 5, 4}},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    DataFlow flow;
    static_cast<void>(row.of(input(flow, 2), input(flow, 3), input(flow, 4)));
    const auto steps = steps_of(flow);
    const FoldedSchedule schedule = folded_schedule(steps, row.parts, kLatencies);
    const LaneWiring wiring = lane_wiring(steps, schedule, row.parts, kLatencies);
    CHECK(wiring.register_words == row.expected.register_words);
    CHECK(wiring.select_words == row.expected.select_words);
    CHECK(wiring.words_written == row.expected.words_written);
    CHECK(wiring.words_selected == row.expected.words_selected);
  }
}

TEST_CASE("longest path: a reciprocal that was taken before is there") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  static_cast<void>(a / c);
  const std::size_t first = flow.size();
  static_cast<void>(b / c);
  const FlowPart second = part_of(flow, first, flow.size());
  CHECK(second.longest_path(kLatencies) == LongestPath{2, 0, 0, 1});
  CHECK(part_of(flow, 0, flow.size()).longest_path(kLatencies) == LongestPath{6, 0, 1, 1});
  const auto steps = second.steps(kLatencies);
  CHECK(folded_schedule(steps, at_least({1, 0, 0, 1}, steps), kLatencies).cycles == 8);
}

}  // namespace sgs::test
