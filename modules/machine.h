// All that a testbench knows of an accelerator: it is given a job when it is made, a memory at its
// sockets, and time; it says when the frame is done, and publishes its data sheet.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/frame_host.h"
#include "tlm/clock_domain.h"
#include "tlm/data_sheet.h"
#include "tlm/instant_end.h"
#include "tlm/router.h"

namespace sgs {

struct FrameJob;

// One in a simulation: its InstantEnd must be the only one.
class Machine : public sc_core::sc_module {
 public:
  // One path to the memory for each requester: sockets of their own, so that nobody waits behind
  // another's request. All are to be bound, to a target that takes several initiators or to several
  // targets with the same bytes behind them. Requests of one instant leave in the order of the
  // requesters, whatever the order in which the kernel runs the units.
  sc_core::sc_vector<::tlm::tlm_initiator_socket<>> memory{"memory"};

  // Where frames of a stream come from; unbound for a single frame.
  FrameHostPort host{"host"};

  // Where it has several frames, for the port of the display, which reads them: a way to the memory
  // that is arbitrated as those of its units are. Bound once, during elaboration.
  void bind_display(MemoryPort& port);

  // Who asks at each of the sockets: the unit's path below the machine.
  const std::vector<std::string>& requesters() const { return requesters_; }

  virtual const ClockDomain& clock() const = 0;

  // The last pixel of the last frame has been handed to the memory.
  bool done() const { return done_; }

  // Everything that its units say of themselves, in the order of the pipeline.
  virtual void publish(DataSheet& sheet) = 0;

 protected:
  explicit Machine(const sc_core::sc_module_name& name) : sc_module(name) {}

  void finish_frame(std::uint32_t frame, bool last) {
    done_ = last;
    ++drawn_;
    if (host.size() > 0) host->drawn(frame);
  }

  // Binds the memory port of every unit that publish() shows to a socket of the machine, in that
  // order, and gives the display one where there are several frames. The last thing that the
  // constructor of a machine does.
  void connect_memory(std::uint32_t frames);

  // The registers that a machine of several frames keeps poses in, where the host writes the next
  // one meanwhile; of two eyes with the right one's place. Units whose lanes take a pose as
  // constants have registers of their own.
  void publish_poses(DataSheet& sheet, const FrameJob& job) const;

  // Arbiter of units that share something: decides who gets it.
  InstantEnd& instant_end() { return instant_end_; }

 private:
  InstantEnd instant_end_{"instant_end"};
  std::unique_ptr<Router> router_;
  std::vector<std::string> requesters_;
  bool done_ = false;
  std::uint32_t drawn_ = 0;  // frames
};

}  // namespace sgs
