// The host's side of a stream of frames: when a frame may begin, when its pixels may be written,
// and what it is told. Units of a machine whose port is unbound draw as if everything were there:
// so does a machine of a single frame.
#pragma once

#include <cstdint>
#include <systemc>

#include "tlm/activity.h"

namespace sgs {

// Frames that a machine has under way: poses that it keeps, and buffers that it draws into in turn.
constexpr std::uint32_t kFramesAtOnce = 2;

// What units see depends on the time alone, not on which of them the kernel runs first: both
// answers change at least a cycle after what they follow from.
class FrameHostIf : public virtual sc_core::sc_interface {
 public:
  // It is there, and so are registers for it: it takes those of the frame drawn two before.
  virtual bool pose_known(std::uint32_t frame) const = 0;
  // Nothing that is shown lies in the frame's buffer any more.
  virtual bool buffer_free(std::uint32_t frame) const = 0;
  // One of the two may have changed.
  virtual const sc_core::sc_event& news() const = 0;

  // Pixels of the frame are there and wait for its buffer, from now on at the latest.
  virtual void awaits_buffer(std::uint32_t frame) = 0;
  // The machine reads the frame's pose now.
  virtual void takes_pose(std::uint32_t frame) = 0;
  // All its pixels are in the memory. Frames come in turn.
  virtual void drawn(std::uint32_t frame) = 0;
};

using FrameHostPort = sc_core::sc_port<FrameHostIf, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

inline bool pose_known(const FrameHostPort& host, std::uint32_t frame) {
  return host.size() == 0 || host->pose_known(frame);
}

// Waits until the frame's pose is known, and takes it.
inline void await_pose(FrameHostPort& host, std::uint32_t frame, Activity& activity) {
  if (host.size() == 0) return;
  while (!host->pose_known(frame)) {
    activity.waits_for(WaitFor::kInput, host);
    sc_core::wait(host->news());
    activity.clock().align();
    activity.works();
  }
  host->takes_pose(frame);
}

// Waits until pixels of the frame may be written.
inline void await_buffer(FrameHostPort& host, std::uint32_t frame, Activity& activity) {
  if (host.size() == 0 || host->buffer_free(frame)) return;
  host->awaits_buffer(frame);
  while (!host->buffer_free(frame)) {
    activity.waits_for(WaitFor::kRoom, host);
    sc_core::wait(host->news());
    activity.clock().align();
    activity.works();
  }
}

}  // namespace sgs
