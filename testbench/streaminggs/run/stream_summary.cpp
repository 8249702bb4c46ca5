#include "testbench/streaminggs/run/stream_summary.h"

#include <algorithm>
#include <cmath>

namespace sgs {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[(values.size() - 1) / 2];
}

}  // namespace

StreamSummary summarise(const StreamResult& stream, double rate) {
  StreamSummary out;
  const std::vector<StreamedFrame>& frames = stream.frames;
  out.frames = frames.size();
  out.rate = rate;
  out.pictures = stream.pictures;
  out.repeated = stream.repeated;
  const double half_s = rate > 0 ? 0.5 / rate : 0;  // to the middle row
  std::vector<double> early, late;
  double busy_until_s = 0;
  for (const StreamedFrame& frame : frames) {
    // Of the picture that was due last when the frame began, within rounding of the kernel's time.
    const double pose_s =
        rate > 0 ? std::max(frame.pose_s, std::floor(frame.begun_s * rate + 1e-6) / rate)
                 : frame.begun_s;
    early.push_back(frame.shown_s + half_s - pose_s);
    late.push_back(frame.shown_s + half_s - frame.begun_s);
    out.idle_s += std::max(0.0, frame.begun_s - busy_until_s);
    busy_until_s = std::max(busy_until_s, frame.drawn_s);
  }
  out.latency_median_s = median(early);
  out.latency_worst_s = *std::max_element(early.begin(), early.end());
  out.late_median_s = median(late);
  out.late_worst_s = *std::max_element(late.begin(), late.end());
  const double behind_s = frames.back().drawn_s - frames.front().drawn_s;
  if (frames.size() > 1) out.frames_s = static_cast<double>(frames.size() - 1) / behind_s;
  return out;
}

}  // namespace sgs
