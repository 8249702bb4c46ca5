#include "testbench/streaminggs/run/path_summary.h"

#include <algorithm>
#include <cmath>

namespace sgs {
namespace {

// quickest_first: not empty.
double fps_at(const std::vector<double>& quickest_first, double share) {
  const double place = std::ceil(share * static_cast<double>(quickest_first.size()));
  return 1 / quickest_first[static_cast<std::size_t>(std::max(place, 1.0)) - 1];
}

}  // namespace

PathSummary summarise(const std::vector<PathFrame>& frames, double rate) {
  PathSummary out;
  out.frames = frames.size();
  out.rate = rate;
  std::vector<double> times;
  Band frames_j, idle_j, with_interface_j;
  double all_s = 0;
  for (const PathFrame& frame : frames) {
    if (frame.time_s > frames[out.worst_frame].time_s) out.worst_frame = times.size();
    times.push_back(frame.time_s);
    const double slot_s = std::max(frame.time_s, 1 / rate);
    out.late += frame.time_s > 1 / rate ? 1 : 0;
    out.empty += frame.empty ? 1 : 0;
    out.memory_known = out.memory_known && frame.memory_known;
    frames_j = frames_j + frame.energy_j;
    idle_j = idle_j + frame.rest_j;
    with_interface_j = with_interface_j + frame.with_interface_j;
    all_s += slot_s;
  }
  std::sort(times.begin(), times.end());
  out.worst_fps = 1 / times.back();
  out.p99_fps = fps_at(times, 0.99);
  out.median_fps = fps_at(times, 0.5);
  out.energy_j = frames_j.middle;
  out.frames_w = (1 / all_s) * frames_j;
  out.idle_w = (1 / all_s) * idle_j;
  out.with_interface_w = (1 / all_s) * with_interface_j;
  return out;
}

}  // namespace sgs
