// stream_summary.h: which frames are held, latencies, and joules between two moments.
#include "testbench/streaminggs/run/stream_summary.h"

#include <catch2/catch.hpp>
#include <vector>

#include "testbench/cost/fixed_rate.h"

namespace sgs::test {
namespace {

FrameResult stream_of(const std::vector<StreamedFrame>& frames) {
  FrameResult run;
  run.clock_mhz = 1000;
  run.cycles = 60000000;
  run.rest_cycles = 2500000;
  run.stream.frames = frames;
  return run;
}

TEST_CASE(
    "stream: a frame behind a repeated picture is missed, and latency counts it from there on") {
  // Pictures at 10, 20, ... ms. The third frame begins 4 ms after its pose was measured, and comes
  // too late for 30 and 40 ms.
  const FrameResult run = stream_of({{0, 0, 0.006, 0.010},
                                     {0.010, 0.010, 0.0195, 0.020},
                                     {0.020, 0.024, 0.041, 0.050},
                                     {0.030, 0.041, 0.054, 0.060, 0.010}});
  const StreamSummary s = summarise(run, 100);
  CHECK(s.missed == std::vector<std::size_t>{2});
  CHECK(s.waiting == 1);
  CHECK(s.buffer_wait.worst_s == Approx(0.010));
  CHECK(s.own_time.worst_s == Approx(0.017));
  CHECK(s.own_time.median_s == Approx(0.006));
  const bool held[] = {true, true, false, true};
  const double pose_s[] = {0, 0.010, 0.020, 0.030};
  const double latency_s[] = {0.015, 0.015, 0.035, 0.035};
  const double late_s[] = {0.015, 0.015, 0.031, 0.024};
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i);
    CHECK(s.frames[i].held == held[i]);
    CHECK(s.frames[i].pose_s == Approx(pose_s[i]).margin(1e-12));
    CHECK(s.frames[i].latency_s == Approx(latency_s[i]));
    CHECK(s.frames[i].latched_late_s == Approx(late_s[i]));
  }
  CHECK(s.latency.median_s == Approx(0.015));
  CHECK(s.latency.worst_s == Approx(0.035));
  CHECK(s.latched_late.worst_s == Approx(0.031));
  CHECK(s.frame_time.worst_s == Approx(0.017));
  CHECK(s.frame_time_p99_s == Approx(0.017));
  CHECK(s.frame_time.median_s == Approx(0.0095));
  CHECK(s.worst_frame == 2);
  CHECK(s.frames_per_s == Approx(3 / 0.050));
  CHECK(s.rest_s == Approx(0.0025));
  CHECK(s.least_wait_s == Approx(0.0005));
}

TEST_CASE("stream: as fast as it goes, the last frame is not counted, which none competes with") {
  const StreamResult four =
      stream_of(
          {{0, 0, 0.006, 0.006}, {0, 0, 0.016, 0.016}, {0, 0, 0.026, 0.026}, {0, 0, 0.03, 0.03}})
          .stream;
  FrameResult run = stream_of({{0, 0, 0.006, 0.006}, {0, 0, 0.016, 0.016}});
  CHECK(summarise(run, 0).frames_per_s == Approx(100));
  run.stream = four;
  CHECK(summarise(run, 0).frames_per_s == Approx(100));
}

TEST_CASE("stream: without a rate every frame is held, and its latency is its own") {
  const StreamSummary s = summarise(stream_of({{0, 0, 0.006, 0.006}, {0, 0.004, 0.011, 0.011}}), 0);
  CHECK(s.missed.empty());
  CHECK(s.latency.worst_s == Approx(0.007));
  CHECK(s.latched_late.worst_s == Approx(0.007));
}

TEST_CASE("stream: its flow is what lies between the first frame's picture and the last one's") {
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const auto at = [](std::uint64_t cycles, std::uint64_t rest, double joules) {
    FrameResult counts;
    counts.clock_mhz = 1000;
    counts.cycles = cycles;
    counts.rest_cycles = rest;
    counts.memory.peak_gb_s = 25.6;
    counts.memory.bytes = 10 * cycles;
    counts.memory.energy_j = counts.memory.energy_least_j = counts.memory.energy_most_j = joules;
    counts.memory.states = {{"active", 1e-9 * static_cast<double>(cycles), joules}};
    counts.memory.commands = {{"read", 0.5 * joules}};
    counts.machine.parts = {{"unit", "register_bit", 320, 320}};
    counts.machine.operations = {{"unit", "register_bit", static_cast<double>(cycles)}};
    return counts;
  };
  FrameResult run = at(50000, 30000, 9);
  run.stream.frames.resize(4);
  run.stream.first_and_last_shown = {at(10000, 5000, 1), at(40000, 25000, 7)};
  StreamSummary held;
  const StreamFlow flow = flow_of(run, held, DramConfig(), technology);
  CHECK(flow.time_s == Approx(30e-6));
  CHECK(flow.frames == 3);
  CHECK(flow.bytes == 300000);
  CHECK(flow.states.at(0).time_s == Approx(30e-6));
  CHECK(flow.states.at(0).energy_j == Approx(6));
  CHECK(flow.commands.at(0).second == Approx(3));
  double sum = 0, clock = 0, dram = 0;
  for (const auto& [component, joules] : flow.energy_j.by_component) {
    sum += joules.middle;
    if (component == "clock") clock = joules.middle;
    if (component == "dram") dram = joules.middle;
  }
  CHECK(sum == Approx(flow.energy_j.total.middle));
  CHECK(dram == Approx(6));
  // Gates of the 10000 cycles in which a frame was under way, and what was clocked.
  constexpr double kGates = 320 / kGatedBits;
  const double bits = technology.part("register_bit").register_bits;
  CHECK(clock == Approx(1e-12 * (30000 * bits * technology.part(kRegisterClock).pj.middle +
                                 10000 * kGates * bits * technology.part(kClockGate).pj.middle)));
  CHECK(flow.power_w().middle == Approx(flow.energy_j.total.middle / 30e-6));
  const Totals watts = flow.totals_w();
  CHECK(watts.without_memory_interface.middle == Approx(flow.power_w().middle));
  const Totals all_j = energy_totals(at(40000, 25000, 7), technology),
               before_j = energy_totals(at(10000, 5000, 1), technology);
  CHECK(watts.memory_interface.high ==
        Approx((all_j.memory_interface.high - before_j.memory_interface.high) / 30e-6));
  // In power-down the memory takes more, at the high end alone.
  const Band awake = flow.energy_j.total;
  for (FrameResult& shown : run.stream.first_and_last_shown) {
    shown.memory.states.push_back({kSelfRefreshState, 0.5 * shown.time_s(), 0});
  }
  const Band resting = flow_of(run, held, DramConfig(), technology).energy_j.total;
  const double more_j = power_down_j(DramConfig(), 15e-6);
  CHECK(more_j > 0);
  CHECK(resting.high == Approx(awake.high + more_j));
  CHECK(resting.middle == awake.middle);
  CHECK(resting.low == awake.low);
  // Ahead of a frame that misses more is drawn than is shown.
  StreamSummary missed;
  missed.missed = {0};
  for (const StreamSummary& summary : {missed, held}) {
    const StreamFlow whole = flow_of(run, summary, DramConfig(), technology);
    CHECK(whole.frames == 4);
    CHECK(whole.time_s == Approx(50e-6));
    CHECK(whole.bytes == 500000);
    CHECK(whole.totals_j.without_memory_interface.middle == Approx(whole.energy_j.total.middle));
    run.stream.first_and_last_shown.clear();
  }
}

}  // namespace
}  // namespace sgs::test
