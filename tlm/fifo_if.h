// The two ends of a FIFO as units see them, and the ports that bind to them.
#pragma once

#include <cstdint>
#include <limits>
#include <systemc>

#include "tlm/activity.h"

namespace sgs {

template <class T>
class FifoWriteIf : public virtual sc_core::sc_interface {
 public:
  // Puts an entry in; blocks the calling thread while the FIFO is full, which is charged to
  // `writer` as waiting for room.
  virtual void push(T value, Activity& writer) = 0;

  // Entries that there is room for now.
  virtual std::uint32_t room() const = 0;
  // Blocks until there is room for so many or, whatever comes first, cycle `until`; charged as
  // push().
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  virtual void wait_for_room(std::uint32_t entries, std::uint64_t until, Activity& writer) = 0;
};

template <class T>
class FifoReadIf : public virtual sc_core::sc_interface {
 public:
  // Takes the oldest entry; blocks the calling thread until there is one and it is ready, which is
  // charged to `reader` as waiting for `what`: a reader that waits for a credit to come back, not
  // for input, passes kRoom.
  virtual T pop(Activity& reader, WaitFor what) = 0;
  T pop(Activity& reader) { return pop(reader, WaitFor::kInput); }

  // True if pop() would return at once.
  virtual bool can_pop() const = 0;
  virtual bool empty() const = 0;
  // When the oldest entry can be taken; only for a FIFO that is not empty.
  virtual const sc_core::sc_time& ready_at() const = 0;
  // Also notifies `event` of every entry put in: for a reader of several FIFOs.
  virtual void announce_to(sc_core::sc_event& event) = 0;
  // The channel itself: the place at which its reader waits.
  virtual const sc_core::sc_object& place() const = 0;
};

// Bound to exactly one FIFO; left open, elaboration fails.
template <class T>
using FifoIn = sc_core::sc_port<FifoReadIf<T>>;
template <class T>
using FifoOut = sc_core::sc_port<FifoWriteIf<T>>;

// Bound to one FIFO or more, numbered in the order of binding.
template <class T>
using FifoIns = sc_core::sc_port<FifoReadIf<T>, 0>;
template <class T>
using FifoOuts = sc_core::sc_port<FifoWriteIf<T>, 0>;

// The FIFO of `ports` whose turn it is: number `turn` modulo how many there are.
template <class If>
If& in_turn(sc_core::sc_port<If, 0>& ports, std::uint64_t turn) {
  return *ports[static_cast<int>(turn % static_cast<std::uint64_t>(ports.size()))];
}

}  // namespace sgs
