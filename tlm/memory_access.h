// Memory accesses as a hardware activity makes them: waiting is charged to it, for room in the port
// or for answers, and the unit goes on at its own next clock edge. Who asks jitters before: at time
// 0 nobody has waited yet.
#pragma once

#include <cstdint>

#include "tlm/activity.h"
#include "tlm/memory_port.h"

namespace sgs {

// Charges the activity's cycles and the port's requests to this group from now on, for timelines
// and the bytes of groups.
inline void take_up_group(Activity& activity, MemoryPort& port, std::uint32_t group,
                          std::uint32_t visit = Activity::kNoVisit) {
  activity.takes_up_group(group, visit);
  port.charge_to(group);
}

inline MemoryPort::Ticket start_read(MemoryPort& port, Activity& activity, std::uint64_t address,
                                     void* into, std::uint32_t bytes, std::uint8_t region) {
  activity.clock().jitter();
  activity.waits_for(WaitFor::kPort, port);
  const MemoryPort::Ticket ticket = port.read(address, into, bytes, region);
  activity.clock().align();
  activity.works();
  return ticket;
}

inline MemoryPort::Ticket start_write(MemoryPort& port, Activity& activity, std::uint64_t address,
                                      const void* from, std::uint32_t bytes, std::uint8_t region) {
  activity.clock().jitter();
  activity.waits_for(WaitFor::kPort, port);
  const MemoryPort::Ticket ticket = port.write(address, from, bytes, region);
  activity.clock().align();
  activity.works();
  return ticket;
}

// Blocks until the data of a read has come.
inline void await(MemoryPort& port, Activity& activity, MemoryPort::Ticket ticket) {
  if (port.done(ticket)) return;
  activity.waits_for(WaitFor::kReads, port);
  port.wait_for(ticket);
  activity.clock().align();
  activity.works();
}

// Blocks until everything that the port has in flight is answered. Writes are charged before reads:
// a caller that waits for all has reads besides only where they are no longer wanted.
inline void await_all(MemoryPort& port, Activity& activity) {
  activity.waits_for(port.writing() ? WaitFor::kWrites : WaitFor::kReads, port);
  port.wait_all();
  activity.clock().align();
  activity.works();
}

}  // namespace sgs
