// Memory accesses as a hardware activity makes them: waiting for room in the port is charged as
// blocked, waiting for data as starved, and the unit goes on at its own next clock edge.
#pragma once

#include <cstdint>

#include "tlm/activity.h"
#include "tlm/memory_port.h"

namespace sgs {

inline MemoryPort::Ticket start_read(MemoryPort& port, Activity& activity, std::uint64_t address,
                                     void* into, std::uint32_t bytes, std::uint8_t region) {
  activity.enter(ActivityState::kBlocked);
  const MemoryPort::Ticket ticket = port.read(address, into, bytes, region);
  activity.clock().align();
  activity.enter(ActivityState::kBusy);
  return ticket;
}

inline MemoryPort::Ticket start_write(MemoryPort& port, Activity& activity, std::uint64_t address,
                                      const void* from, std::uint32_t bytes, std::uint8_t region) {
  activity.enter(ActivityState::kBlocked);
  const MemoryPort::Ticket ticket = port.write(address, from, bytes, region);
  activity.clock().align();
  activity.enter(ActivityState::kBusy);
  return ticket;
}

inline void await(MemoryPort& port, Activity& activity, MemoryPort::Ticket ticket) {
  if (port.done(ticket)) return;
  activity.enter(ActivityState::kStarved);
  port.wait_for(ticket);
  activity.clock().align();
  activity.enter(ActivityState::kBusy);
}

// Until everything that the port has in flight is answered.
inline void await_all(MemoryPort& port, Activity& activity) {
  activity.enter(ActivityState::kStarved);
  port.wait_all();
  activity.clock().align();
  activity.enter(ActivityState::kBusy);
}

}  // namespace sgs
