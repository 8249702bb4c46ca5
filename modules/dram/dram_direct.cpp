// The memory's calls without phases: blocking transport, debug transport, loading and reading back.
#include <algorithm>

#include "modules/dram/byte_store.h"
#include "modules/dram/dram_controller.h"

namespace sgs {

void DramController::load(std::uint64_t address, const void* from, std::size_t bytes) {
  store_.write(address, static_cast<const std::uint8_t*>(from), bytes);
}

void DramController::read_back(std::uint64_t address, void* into, std::size_t bytes) const {
  store_.read(address, static_cast<std::uint8_t*>(into), bytes);
}

void DramController::b_transport(int initiator, tlm::tlm_generic_payload& payload,
                                 sc_core::sc_time& delay) {
  if (!uses(Transport::kBlocking) || !move_bytes(payload, store_)) return;
  const sc_core::sc_time start = sc_core::sc_time_stamp() + delay;
  Transaction& t = new_transaction(initiator, payload, start);
  while (t.next < t.end) {
    std::uint32_t channel = 0;
    const ChannelRequest request = next_request(t, channel);
    t.done = std::max(t.done, channels_[channel].arrival_order.serve(request, t.arrival));
  }
  // Time in which requests are there: the union of their intervals.
  commands_.counts.busy_cycles += t.done - std::min(t.done, std::max(t.arrival, busy_until_));
  busy_until_ = std::max(busy_until_, t.done);
  (t.direction == Direction::kRead ? commands_.counts.read_latency_cycles
                                   : commands_.counts.write_latency_cycles)
      .add(t.done - t.arrival);
  free_transactions_.push_back(&t);
  delay = time_of(t.done) - sc_core::sc_time_stamp();
}

unsigned int DramController::transport_dbg(int, tlm::tlm_generic_payload& payload) {
  if (payload.get_address() >= capacity_bytes()) return 0;
  const std::uint64_t room = capacity_bytes() - payload.get_address();
  const auto length =
      static_cast<unsigned int>(std::min<std::uint64_t>(payload.get_data_length(), room));
  if (payload.is_read())
    store_.read(payload.get_address(), payload.get_data_ptr(), length);
  else if (payload.is_write())
    store_.write(payload.get_address(), payload.get_data_ptr(), length);
  else
    return 0;
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return length;
}

}  // namespace sgs
