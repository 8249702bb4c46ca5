// Frame rates and power over the frames of a camera path.
#pragma once

#include <cstddef>
#include <vector>

#include "testbench/cost/technology.h"

namespace sgs {

// Time and energy of one frame, and the energy until the next one begins; none where it is late.
struct PathFrame {
  double time_s = 0;
  Band energy_j, rest_j;
  Band with_interface_j;     // both, and PHY and controller of the memory
  bool empty = false;        // no Gaussian contributes
  bool memory_known = true;  // the memory's energy is; if not, these are without it
};

struct PathSummary {
  std::size_t frames = 0, empty = 0;
  double worst_fps = 0, p99_fps = 0, median_fps = 0;
  std::size_t worst_frame = 0;
  double energy_j = 0;       // of all frames
  bool memory_known = true;  // as PathFrame has it, of all
  double rate = 0;           // as given
  // With a frame begun every 1 / rate, or when the one before it is done: those done later, and the
  // joules a second for frames and between them.
  std::size_t late = 0;
  Band frames_w, idle_w;
  Band with_interface_w;  // both, and PHY and controller of the memory
};

// frames: at least one. rate: frames a second. 99 of 100 frames reach p99_fps: it is that of the
// frame at place ceil(0.99 n) when the quickest comes first; the median is at ceil(0.5 n).
PathSummary summarise(const std::vector<PathFrame>& frames, double rate);

}  // namespace sgs
