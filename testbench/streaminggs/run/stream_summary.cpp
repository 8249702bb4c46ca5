// Orders of times, and differences of counts.
#include "testbench/streaminggs/run/stream_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "testbench/cost/fixed_rate.h"

namespace sgs {
namespace {

double at_share(std::vector<double> times, double share) {
  std::sort(times.begin(), times.end());
  const double place = std::ceil(share * static_cast<double>(times.size()));
  return times[static_cast<std::size_t>(std::max(place, 1.0)) - 1];
}

template <class Time>
MedianAndWorst median_and_worst(const std::vector<FrameTiming>& frames, const Time& time_of) {
  std::vector<double> times;
  for (const FrameTiming& frame : frames) times.push_back(time_of(frame));
  return {at_share(times, 0.5), at_share(times, 1)};
}

// Moments are rounded to the kernel's resolution; a picture lies whole periods after another.
constexpr double kOfPeriod = 1e-6;

}  // namespace

StreamSummary summarise(const FrameResult& run, double rate) {
  const StreamResult& stream = run.stream;
  StreamSummary out;
  out.rest_s = static_cast<double>(run.rest_cycles) / (run.clock_mhz * 1e6);
  out.rate = rate;
  out.pictures = stream.pictures;
  out.repeated = stream.repeated;
  out.rows_late = stream.rows_late;
  const double period_s = rate > 0 ? 1 / rate : 0;
  out.least_wait_s = std::numeric_limits<double>::infinity();
  double shown_before_s = 0;
  std::vector<double> times;
  for (const StreamedFrame& of : stream.frames) {
    FrameTiming frame;
    frame.begun_s = of.begun_s;
    frame.drawn_s = of.drawn_s;
    frame.shown_s = of.shown_s;
    frame.pose_s = rate > 0 ? of.pose_s : of.begun_s;
    frame.held = rate == 0 || of.shown_s - shown_before_s < (1 + kOfPeriod) * period_s;
    shown_before_s = of.shown_s;
    const double light_s = of.shown_s + period_s / 2;
    frame.latency_s = light_s - frame.pose_s;
    frame.latched_late_s = light_s - of.begun_s;
    out.least_wait_s = std::min(out.least_wait_s, of.shown_s - of.drawn_s);
    frame.buffer_wait_s = of.buffer_wait_s;
    if (!frame.held) out.missed.push_back(out.frames.size());
    out.waiting += frame.buffer_wait_s > 0 ? 1 : 0;
    times.push_back(frame.time_s());
    if (frame.time_s() > times[out.worst_frame]) out.worst_frame = times.size() - 1;
    out.frames.push_back(frame);
  }
  out.frame_time = median_and_worst(out.frames, [](const FrameTiming& f) { return f.time_s(); });
  out.own_time = median_and_worst(out.frames, [](const FrameTiming& f) { return f.own_time_s(); });
  out.buffer_wait =
      median_and_worst(out.frames, [](const FrameTiming& f) { return f.buffer_wait_s; });
  out.frame_time_p99_s = at_share(times, 0.99);
  out.latency = median_and_worst(out.frames, [](const FrameTiming& f) { return f.latency_s; });
  out.latched_late =
      median_and_worst(out.frames, [](const FrameTiming& f) { return f.latched_late_s; });
  const std::size_t last = out.frames.size() - 1;
  const std::size_t until = rate == 0 && last > 1 ? last - 1 : last;
  const double behind_s = out.frames[until].shown_s - out.frames.front().shown_s;
  out.frames_per_s = static_cast<double>(until) / behind_s;
  return out;
}

namespace {

// The memory's band ends all in power-down.
void end_in_power_down(StreamFlow& flow, const DramConfig& dram) {
  double self_refresh_s = 0;
  for (const MemoryState& state : flow.states) {
    if (state.name == kSelfRefreshState) self_refresh_s += state.time_s;
  }
  for (auto& [component, joules] : flow.energy_j.by_component) {
    if (component != "dram" || self_refresh_s == 0) continue;
    const double more = power_down_j(dram, self_refresh_s);
    joules.high += more;
    for (Band* total : {&flow.energy_j.total, &flow.totals_j.without_memory_interface,
                        &flow.totals_j.with_memory_interface}) {
      total->high += more;
    }
  }
}

StreamFlow simulated_flow(const FrameResult& run, const StreamSummary& summary,
                          const Technology& technology) {
  const std::vector<FrameResult>& shown = run.stream.first_and_last_shown;
  const bool whole = shown.empty() || !summary.missed.empty();
  StreamFlow flow;
  const FrameResult& end = whole ? run : shown.back();
  flow.states = end.memory.states;
  flow.commands = end.memory.commands;
  flow.bytes = end.memory.bytes;
  flow.bus_bytes = end.memory.bus_bytes;
  flow.time_s = end.time_s();
  flow.frames = run.stream.frames.size();
  flow.totals_j = energy_totals(end, technology);
  if (whole) {
    flow.energy_j = energy_of(run, technology);
    return flow;
  }
  const FrameResult& begin = shown.front();
  flow.energy_j = energy_between(begin, end, technology);
  flow.totals_j = flow.totals_j + -1 * energy_totals(begin, technology);
  flow.time_s -= begin.time_s();
  --flow.frames;
  flow.bytes -= begin.memory.bytes;
  flow.bus_bytes -= begin.memory.bus_bytes;
  for (std::size_t s = 0; s < flow.states.size(); ++s) {
    flow.states[s].time_s -= begin.memory.states[s].time_s;
    flow.states[s].energy_j -= begin.memory.states[s].energy_j;
  }
  for (std::size_t c = 0; c < flow.commands.size(); ++c) {
    flow.commands[c].second -= begin.memory.commands[c].second;
  }
  return flow;
}

}  // namespace

StreamFlow flow_of(const FrameResult& run, const StreamSummary& summary, const DramConfig& dram,
                   const Technology& technology) {
  StreamFlow flow = simulated_flow(run, summary, technology);
  end_in_power_down(flow, dram);
  return flow;
}

}  // namespace sgs
