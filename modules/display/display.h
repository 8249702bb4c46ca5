// The host and its display, at the machine's side of a stream of frames. Poses come at the
// display's rate. A frame that is in the memory when a picture is due is shown from then on, read
// row by row; else the frame before it is shown again. There are two frame buffers: the machine
// draws into the one that is not shown. Of two eyes each has two, and the same row of both is shown
// at once.
// Timing: a row is read while the one before it is shown, from a buffer of two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <systemc>
#include <vector>

#include "modules/frame_host.h"
#include "modules/frame_job.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_port.h"

namespace sgs {

struct FrameTimes {
  sc_core::sc_time pose;   // from which on it was there
  sc_core::sc_time begun;  // the machine read the pose
  sc_core::sc_time drawn;  // its last pixel came to the memory
  sc_core::sc_time shown;  // its first row is read for the first time
  sc_core::sc_time kept;   // pixels began to wait for the buffer; never: none did
};

class Display : public sc_core::sc_module, public FrameHostIf {
 public:
  MemoryPort memory;  // rows of pixels

  SC_HAS_PROCESS(Display);
  // job: outlives it. rate: pictures a second; 0: any pose is there at once, and a frame is shown
  // as soon as it is drawn, in no time, by no hardware. cycle: of the machine's clock, after which
  // it sees what has changed.
  Display(const sc_core::sc_module_name& name, const FrameJob& job, double rate,
          const sc_core::sc_time& cycle);

  // Called for each eye with the number of a frame that is shown, and its bytes as they were read;
  // with rate 0 null.
  std::function<void(std::uint32_t frame, std::uint32_t eye, const std::byte* bytes)> on_shown;
  // Called when no frame is under way and the next pose is yet to come, and when it has come.
  std::function<void(bool rests)> on_rest = [](bool) {};

  // `picture` from 1 on. With a rate, the first frame is shown in picture 1 at the earliest.
  sc_core::sc_time due(std::uint64_t picture) const {
    return static_cast<double>(picture) * period_;
  }
  const std::vector<FrameTimes>& times() const { return times_; }
  std::uint32_t frames_shown() const { return shown_; }
  sc_core::sc_time rested() const;  // so far, as on_rest() says
  // For which the frame's pixels waited until the display left its buffer.
  sc_core::sc_time buffer_wait(std::uint32_t frame) const;

  // From the first frame's picture to the last one's.
  struct Counters : CounterSet {
    Counter pictures{*this, "pictures", "pictures", "shown"};
    Counter repeated{*this, "repeated", "pictures", "of these, for want of the next frame"};
    Counter rows{*this, "rows", "rows", "read, of both eyes where there are two"};
    Counter rows_late{*this, "rows_late", "rows", "of these, not there when they were to be shown"};
  };
  const Counters& counters() const { return counters_; }
  void publish(DataSheet& sheet);

  bool pose_known(std::uint32_t frame) const override;
  bool buffer_free(std::uint32_t frame) const override;
  const sc_core::sc_event& news() const override { return news_.default_event(); }
  void awaits_buffer(std::uint32_t frame) override;
  void takes_pose(std::uint32_t frame) override;
  void drawn(std::uint32_t frame) override;

 private:
  void run();  // thread: pictures
  void show_next();
  void scan_out(const sc_core::sc_time& due);
  void read_row(int y);
  void revise_rest();
  std::uint32_t row_bytes() const;
  // After that instant: one that has passed for every unit, whichever the kernel runs first.
  bool is_past(const sc_core::sc_time& at) const;

  const FrameJob& job_;
  const sc_core::sc_time period_, cycle_;  // period 0: no rate
  std::vector<FrameTimes> times_;
  std::uint32_t taken_ = 0, drawn_ = 0, shown_ = 0;  // frames
  bool rests_ = false;
  sc_core::sc_time rests_since_, rested_;
  std::vector<std::vector<std::byte>> pictures_;  // [eye]
  sc_core::sc_event_queue news_;
  Counters counters_;
};

}  // namespace sgs
