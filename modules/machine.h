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
    if (host.size() > 0) host->drawn(frame);
  }

  // Binds the memory port of every unit that publish() shows to a socket of the machine, in that
  // order. The last thing that the constructor of a machine does.
  void connect_memory();

  // Arbiter of units that share something: decides who gets it.
  InstantEnd& instant_end() { return instant_end_; }

 private:
  InstantEnd instant_end_{"instant_end"};
  std::unique_ptr<Router> router_;
  std::vector<std::string> requesters_;
  bool done_ = false;
};

}  // namespace sgs
