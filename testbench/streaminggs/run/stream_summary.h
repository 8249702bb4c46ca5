// Rates and latencies of a stream of frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "testbench/result/frame_result.h"

namespace sgs {

struct StreamSummary {
  std::size_t frames = 0;
  double rate = 0;      // pictures a second as asked for; 0: each frame as soon as it is drawn
  double frames_s = 0;  // frames a second behind the first, from last pixel to last pixel
  std::uint64_t pictures = 0, repeated = 0;
  bool held() const { return repeated == 0; }
  // Of a frame: from its pose to the light of the picture's middle row. With the pose of the
  // display's last picture before the frame began, and with the pose as it is when the frame
  // begins.
  double latency_median_s = 0, latency_worst_s = 0, late_median_s = 0, late_worst_s = 0;
  // Time in which no frame is under way.
  double idle_s = 0;
};

// stream: at least one frame.
StreamSummary summarise(const StreamResult& stream, double rate);

}  // namespace sgs
