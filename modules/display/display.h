// The host and its display, at the machine's side of a stream of frames. Poses come at the
// display's rate. A frame that is in the memory when a picture is due is shown from then on, read
// row by row; else the frame before it is shown again. There are two frame buffers: the machine
// draws into the one that is not shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "modules/frame_host.h"
#include "modules/frame_job.h"
#include "tlm/memory_port.h"

namespace sgs {

constexpr std::uint32_t kFrameBuffers = 2;

struct FrameTimes {
  sc_core::sc_time pose;   // from which on it was there
  sc_core::sc_time begun;  // the machine read the pose
  sc_core::sc_time drawn;  // its last pixel came to the memory
  sc_core::sc_time shown;  // its first row is read for the first time
};

class Display : public sc_core::sc_module, public FrameHostIf {
 public:
  MemoryPort memory;  // rows of pixels; to be bound where the rate is not 0

  SC_HAS_PROCESS(Display);
  // job: outlives it. rate: pictures a second; 0: any pose is there at once, and a frame is shown
  // as soon as it is drawn, in no time. cycle: of the machine's clock, after which it sees what
  // has changed.
  Display(const sc_core::sc_module_name& name, const FrameJob& job, double rate,
          const sc_core::sc_time& cycle);

  // Called with the number of a frame that is shown and will not be shown again, and its bytes;
  // with rate 0 as soon as it is shown, with null.
  std::function<void(std::uint32_t frame, const std::byte* bytes)> on_shown;

  const std::vector<FrameTimes>& times() const { return times_; }
  std::uint64_t pictures() const { return pictures_; }  // from the first frame's to the last one's
  std::uint64_t repeated() const { return repeated_; }  // of these, for want of the next frame

  bool pose_known(std::uint32_t frame) const override;
  bool buffer_free(std::uint32_t frame) const override;
  const sc_core::sc_event& news() const override { return news_.default_event(); }
  void takes_pose(std::uint32_t frame) override;
  void drawn(std::uint32_t frame) override;

 private:
  void run();  // thread: pictures
  void show_next();
  void scan_out(const sc_core::sc_time& due);
  sc_core::sc_time due(std::uint64_t picture) const {
    return static_cast<double>(picture) * period_;
  }

  const FrameJob& job_;
  const sc_core::sc_time period_, cycle_;  // period 0: no rate
  std::vector<FrameTimes> times_;
  std::uint32_t drawn_ = 0, shown_ = 0;  // frames
  std::uint64_t pictures_ = 0, repeated_ = 0;
  std::vector<std::byte> picture_;
  sc_core::sc_event_queue news_;
};

}  // namespace sgs
