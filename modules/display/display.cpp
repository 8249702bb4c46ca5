// Pictures, one after the other.
#include "modules/display/display.h"

namespace sgs {
namespace {

sc_core::sc_time never() { return sc_core::sc_max_time(); }

sc_core::sc_time period_of(double rate) {
  return rate > 0 ? sc_core::sc_time(1 / rate, sc_core::SC_SEC) : sc_core::SC_ZERO_TIME;
}

}  // namespace

Display::Display(const sc_core::sc_module_name& name, const FrameJob& job, double rate,
                 const sc_core::sc_time& cycle)
    : sc_module(name),
      memory("memory", MemoryPortConfig{}, cycle),
      job_(job),
      period_(period_of(rate)),
      cycle_(cycle),
      times_(job.frames(), FrameTimes{never(), never(), never(), never()}),
      picture_(job.frame_buffer.bytes),
      news_("news") {
  for (std::uint32_t frame = 0; frame < job.frames(); ++frame) times_[frame].pose = due(frame);
  if (rate > 0) SC_THREAD(run);
}

bool Display::pose_known(std::uint32_t frame) const {
  return times_[frame].pose <= sc_core::sc_time_stamp();
}

bool Display::buffer_free(std::uint32_t frame) const {
  if (frame < kFrameBuffers) return true;
  const sc_core::sc_time& next_shown = times_[frame - kFrameBuffers + 1].shown;
  return next_shown != never() && next_shown + cycle_ <= sc_core::sc_time_stamp();
}

void Display::takes_pose(std::uint32_t frame) { times_[frame].begun = sc_core::sc_time_stamp(); }

void Display::drawn(std::uint32_t frame) {
  times_[frame].drawn = sc_core::sc_time_stamp();
  ++drawn_;
  if (period_ != sc_core::SC_ZERO_TIME) return;
  show_next();
  on_shown(frame, nullptr);
}

void Display::show_next() {
  times_[shown_++].shown = sc_core::sc_time_stamp();
  news_.notify(cycle_);
}

void Display::run() {
  for (std::uint64_t picture = 1; shown_ < job_.frames(); ++picture) {
    const sc_core::sc_time at = due(picture);
    sc_core::wait(at - sc_core::sc_time_stamp());
    news_.notify(sc_core::SC_ZERO_TIME);  // a pose is there
    const bool there = shown_ < drawn_ && times_[shown_].drawn < at;
    if (there) show_next();
    if (shown_ == 0) continue;
    ++pictures_;
    repeated_ += there ? 0 : 1;
    scan_out(at);
    if (there) on_shown(shown_ - 1, picture_.data());
  }
}

// Rows are read at even distances, the last before the next picture is due.
void Display::scan_out(const sc_core::sc_time& due) {
  const Picture& of = job_.picture(shown_ - 1);
  const auto row_bytes = static_cast<std::uint32_t>(of.view.width) * pixel_bytes(of.frame_format);
  const sc_core::sc_time of_row = period_ / (of.view.height + 1);
  for (int y = 0; y < of.view.height; ++y) {
    const sc_core::sc_time at = due + static_cast<double>(y) * of_row;
    if (at > sc_core::sc_time_stamp()) sc_core::wait(at - sc_core::sc_time_stamp());
    memory.read(of.pixel_address(0, y), picture_.data() + std::size_t{row_bytes} * y, row_bytes,
                of.frame_buffer.region);
  }
  memory.wait_all();
}

}  // namespace sgs
