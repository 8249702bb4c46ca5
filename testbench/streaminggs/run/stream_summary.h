// Times, latencies and joules of a stream of frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "testbench/cost/cost.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// Seconds since the start, but for latencies and waits.
struct FrameTiming {
  double pose_s = 0;   // its pose was measured: without a display when the frame began
  double begun_s = 0;  // the machine took it
  double drawn_s = 0, shown_s = 0;
  double buffer_wait_s = 0;  // its pixels waited so long for a buffer that the display showed
  // The frame is shown in the picture behind that of the frame before it; the first in the first
  // picture. Without a display all are.
  bool held = true;
  double time_s() const { return drawn_s - begun_s; }
  double own_time_s() const { return time_s() - buffer_wait_s; }
  // To the light of the picture's middle row: from pose_s, and from begun_s as if the pose was
  // measured then.
  double latency_s = 0, latched_late_s = 0;
};

// The middle and the largest of several times.
struct MedianAndWorst {
  double median_s = 0, worst_s = 0;
};

struct StreamSummary {
  double rate = 0;  // pictures a second as asked for; 0: each frame as soon as it is drawn
  std::vector<FrameTiming> frames;
  std::uint64_t pictures = 0, repeated = 0, rows_late = 0;
  std::vector<std::size_t> missed;  // numbers of the frames that are not held
  std::size_t waiting = 0;          // frames that wait for their buffer
  // From the first to the last that is shown. Without a rate to the last but one: behind the last
  // no other frame asks for the memory.
  double frames_per_s = 0;
  MedianAndWorst frame_time, own_time, buffer_wait, latency, latched_late;
  double least_wait_s = 0;      // of a frame in memory, for its picture
  double rest_s = 0;            // in which no frame is under way
  double frame_time_p99_s = 0;  // at place ceil(0.99 n) when the quickest comes first
  std::size_t worst_frame = 0;
};

// run: of a stream, of at least two frames.
StreamSummary summarise(const FrameResult& run, double rate);

// What a stream takes while it flows: where every frame is held, from the first one's picture to
// the last one's, so that as many frames are drawn as are shown; else from its start to its end.
struct StreamFlow {
  double time_s = 0;
  std::size_t frames = 0;
  CostResult energy_j;
  Totals totals_j;  // the same
  std::uint64_t bytes = 0, bus_bytes = 0;
  std::vector<MemoryState> states;
  std::vector<std::pair<std::string, double>> commands;  // J
  Band power_w() const { return 1 / time_s * energy_j.total; }
  Totals totals_w() const { return 1 / time_s * totals_j; }
};

// summary: of the run. dram: of its simulation. High: the memory is in power-down where it
// refreshed itself.
StreamFlow flow_of(const FrameResult& run, const StreamSummary& summary, const DramConfig& dram,
                   const Technology& technology);

}  // namespace sgs
