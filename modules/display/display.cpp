// Pictures, one after the other.
#include "modules/display/display.h"

#include <algorithm>

namespace sgs {
namespace {

constexpr const char *kMemory = "display", *kRows = "rows shown";

sc_core::sc_time never() { return sc_core::sc_max_time(); }

// A row that comes late is of no use.
MemoryPortConfig port_config() {
  MemoryPortConfig config;
  config.urgent = true;
  return config;
}

sc_core::sc_time period_of(double rate) {
  return rate > 0 ? sc_core::sc_time(1 / rate, sc_core::SC_SEC) : sc_core::SC_ZERO_TIME;
}

}  // namespace

Display::Display(const sc_core::sc_module_name& name, const FrameJob& job, double rate,
                 const sc_core::sc_time& cycle)
    : sc_module(name),
      memory("memory", port_config(), cycle),
      job_(job),
      period_(period_of(rate)),
      cycle_(cycle),
      times_(job.frames(), FrameTimes{never(), never(), never(), never(), never()}),
      pictures_(job.eyes, std::vector<std::byte>(job.frame_buffer.bytes)),
      news_("news") {
  for (std::uint32_t frame = 0; frame < job.frames(); ++frame) times_[frame].pose = due(frame);
  if (rate > 0) SC_THREAD(run);
}

bool Display::is_past(const sc_core::sc_time& at) const {
  return at != never() && at + cycle_ <= sc_core::sc_time_stamp();
}

bool Display::pose_known(std::uint32_t frame) const {
  if (times_[frame].pose > sc_core::sc_time_stamp()) return false;
  return frame < kFramesAtOnce || is_past(times_[frame - kFramesAtOnce].drawn);
}

bool Display::buffer_free(std::uint32_t frame) const {
  return frame < kFramesAtOnce || is_past(times_[frame - kFramesAtOnce + 1].shown);
}

void Display::awaits_buffer(std::uint32_t frame) {
  if (period_ == sc_core::SC_ZERO_TIME) return;  // the frame before is not drawn yet
  times_[frame].kept = std::min(times_[frame].kept, sc_core::sc_time_stamp());
}

sc_core::sc_time Display::buffer_wait(std::uint32_t frame) const {
  const sc_core::sc_time& since = times_[frame].kept;
  if (since == never()) return sc_core::SC_ZERO_TIME;
  return times_[frame - kFramesAtOnce + 1].shown + cycle_ - since;
}

void Display::takes_pose(std::uint32_t frame) {
  times_[frame].begun = sc_core::sc_time_stamp();
  ++taken_;
  revise_rest();
}

void Display::drawn(std::uint32_t frame) {
  times_[frame].drawn = sc_core::sc_time_stamp();
  ++drawn_;
  news_.notify(cycle_);
  revise_rest();
  if (period_ != sc_core::SC_ZERO_TIME) return;
  show_next();
  for (std::uint32_t eye = 0; eye < job_.eyes; ++eye) on_shown(frame, eye, nullptr);
}

void Display::revise_rest() {
  const sc_core::sc_time& now = sc_core::sc_time_stamp();
  const bool rests = taken_ == drawn_ && (taken_ == times_.size() || times_[taken_].pose > now);
  if (rests == rests_) return;
  rests_ = rests;
  if (rests) {
    rests_since_ = now;
  } else {
    rested_ += now - rests_since_;
  }
  on_rest(rests);
}

sc_core::sc_time Display::rested() const {
  return rested_ + (rests_ ? sc_core::sc_time_stamp() - rests_since_ : sc_core::SC_ZERO_TIME);
}

void Display::show_next() {
  times_[shown_++].shown = sc_core::sc_time_stamp();
  news_.notify(cycle_);
}

void Display::run() {
  for (std::uint64_t picture = 1; shown_ < job_.frames(); ++picture) {
    const sc_core::sc_time at = due(picture);
    // Where rows come so late that the next picture is due, that one is left out.
    if (at < sc_core::sc_time_stamp()) continue;
    sc_core::wait(at - sc_core::sc_time_stamp());
    news_.notify(sc_core::SC_ZERO_TIME);  // a pose is there
    revise_rest();
    const bool there = shown_ < drawn_ && times_[shown_].drawn < at;
    if (there) show_next();
    if (shown_ == 0) continue;
    ++counters_.pictures;
    counters_.repeated += there ? 0 : 1;
    scan_out(at);
    for (std::uint32_t eye = 0; there && eye < job_.eyes; ++eye) {
      on_shown(shown_ - 1, eye, pictures_[eye].data());
    }
  }
}

// The last row is shown before the next picture is due.
void Display::scan_out(const sc_core::sc_time& due) {
  const int height = job_.view.height;
  const sc_core::sc_time of_row = period_ / (height + 1);
  for (int y = 0; y < height; ++y) {
    const sc_core::sc_time at = due + static_cast<double>(y) * of_row;
    if (at > sc_core::sc_time_stamp()) sc_core::wait(at - sc_core::sc_time_stamp());
    read_row(y);
    ++counters_.rows;
    memory.wait_all();
    counters_.rows_late += sc_core::sc_time_stamp() > at + of_row ? 1 : 0;
  }
}

void Display::read_row(int y) {
  for (std::uint32_t eye = 0; eye < job_.eyes; ++eye) {
    const Picture& of = job_.picture(shown_ - 1, eye);
    memory.read(of.pixel_address(0, y), pictures_[eye].data() + std::size_t{row_bytes()} * y,
                row_bytes(), of.frame_buffer.region);
  }
}

std::uint32_t Display::row_bytes() const {
  return static_cast<std::uint32_t>(job_.view.width) * pixel_bytes(job_.frame_format);
}

void Display::publish(DataSheet& sheet) {
  if (period_ == sc_core::SC_ZERO_TIME) return;
  constexpr std::uint32_t kHeldRows = 2;
  const std::uint32_t width_bits = 8 * std::min(kPortBytes, row_bytes());
  SramUses uses = {
      sram_use(kRows, kMemory, {{kHeldRows, "rows"}, {row_bytes(), "B"}}, {width_bits}, kOneOfEach),
      outstanding_table(kMemory, memory.config())};
  uses.front().count = job_.eyes;
  uses.back().name += " of the display";
  sheet.unit(*this);
  sheet.counters(counters_);
  sheet.sram(uses);
  const std::uint64_t words =
      counters_.rows * job_.eyes * sram_words(row_bytes(), uses.front().shape);
  sheet.accesses(kRows, words, words);
  sheet.port(memory);
  sheet.sram_available(kMemory, sram_bytes(uses, kMemory));
}

}  // namespace sgs
