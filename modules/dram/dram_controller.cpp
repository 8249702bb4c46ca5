// The memory: a TLM-2.0 target that stores bytes and answers with DRAM timing.
#include "modules/dram/dram_controller.h"

#include "tlm/memory_extension.h"

namespace sgs {

namespace {
DramConfig validated(const DramConfig& config) {
  config.validate();
  return config;
}
}  // namespace

DramController::DramController(const sc_core::sc_module_name& name, const DramConfig& config)
    : sc_module(name),
      socket("socket"),
      config_(validated(config)),
      memspec_(load_memspec(config.memspec)),
      mapping_(config_, memspec_),
      clock_period_(memspec_.clock_period_ns, sc_core::SC_NS),
      store_(mapping_.capacity_bytes()) {
  socket.register_nb_transport_fw(this, &DramController::nb_transport_fw);
  socket.register_b_transport(this, &DramController::b_transport);
  socket.register_transport_dbg(this, &DramController::transport_dbg);
  for (std::uint32_t c = 0; c < config_.channels; ++c)
    channels_.emplace_back(config_, memspec_, static_cast<std::uint8_t>(c), *this);
  stats_.channels.resize(config_.channels);
  stats_.clock_period_ns = memspec_.clock_period_ns;
  stats_.peak_gb_per_s = memspec_.peak_gb_per_s() * config_.channels;
  stats_.burst_bytes = memspec_.burst_bytes();
  SC_METHOD(answer);
  sensitive << answer_event_;
  dont_initialize();
}

void DramController::load(std::uint64_t address, const void* from, std::size_t bytes) {
  store_.write(address, static_cast<const std::uint8_t*>(from), bytes);
}

void DramController::read_back(std::uint64_t address, void* into, std::size_t bytes) const {
  store_.read(address, static_cast<std::uint8_t*>(into), bytes);
}

std::uint64_t DramController::cycle_of(const sc_core::sc_time& time) const {
  return (time.value() + clock_period_.value() - 1) / clock_period_.value();
}

DramStats DramController::stats() {
  const std::uint64_t now = cycle_of(sc_core::sc_time_stamp());
  DramStats stats = stats_;
  stats.elapsed_cycles = now;
  for (std::size_t c = 0; c < channels_.size(); ++c) stats.channels[c].rows = channels_[c].rows();
  return stats;
}

bool DramController::accept(tlm::tlm_generic_payload& payload) {
  const std::uint64_t address = payload.get_address();
  const std::size_t length = payload.get_data_length();
  if (address >= capacity_bytes() || length > capacity_bytes() - address) {
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    return false;
  }
  if (length == 0 || payload.get_streaming_width() < length) {
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
    return false;
  }
  if (payload.get_byte_enable_ptr() != nullptr) {
    payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    return false;
  }
  if (payload.is_read()) {
    store_.read(address, payload.get_data_ptr(), length);
  } else if (payload.is_write()) {
    store_.write(address, payload.get_data_ptr(), length);
  } else {
    payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
    return false;
  }
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return true;
}

std::uint64_t DramController::serve(const tlm::tlm_generic_payload& payload, std::uint64_t cycle) {
  const auto* memory = payload.get_extension<MemoryExtension>();
  const auto direction = payload.is_read() ? Direction::kRead : Direction::kWrite;
  stats_.traffic.add(memory ? memory->requester : 0, memory ? memory->region : 0, direction,
                     payload.get_data_length());
  const std::uint64_t run = mapping_.run_bytes();
  const std::uint32_t burst = mapping_.burst_bytes();
  std::uint64_t address = payload.get_address() / burst * burst;
  const std::uint64_t end = payload.get_address() + payload.get_data_length();
  std::uint64_t done = cycle;
  while (address < end) {
    const std::uint64_t stop = std::min(end, (address / run + 1) * run);
    const DramAddress place = mapping_.decode(address);
    ChannelRequest request;
    request.direction = direction;
    request.region = memory ? memory->region : 0;
    request.rank = place.rank;
    request.bank = place.bank;
    request.row = place.row;
    request.burst = place.burst;
    request.bursts = static_cast<std::uint32_t>((stop - address + burst - 1) / burst);
    done = std::max(done, channels_[place.channel].serve(request, cycle));
    address = stop;
  }
  (direction == Direction::kRead ? stats_.read_latency_cycles : stats_.write_latency_cycles)
      .add(done - cycle);
  return done;
}

void DramController::b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (!accept(payload)) return;
  const sc_core::sc_time now = sc_core::sc_time_stamp();
  const std::uint64_t done = serve(payload, cycle_of(now + delay));
  delay = clock_period_ * static_cast<double>(done) - now;
}

tlm::tlm_sync_enum DramController::nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                                   tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  if (phase != tlm::BEGIN_REQ) return tlm::TLM_COMPLETED;
  if (!accept(payload)) return tlm::TLM_COMPLETED;
  payload.acquire();
  ++in_flight_;
  const std::uint64_t done = serve(payload, cycle_of(sc_core::sc_time_stamp() + delay));
  const sc_core::sc_time at = clock_period_ * static_cast<double>(done);
  if (answers_.empty() || at < answers_.top().at)
    answer_event_.notify(at - sc_core::sc_time_stamp());
  answers_.push({at, next_order_++, initiator, &payload});
  phase = tlm::END_REQ;
  return tlm::TLM_UPDATED;
}

void DramController::answer() {
  while (!answers_.empty() && answers_.top().at <= sc_core::sc_time_stamp()) {
    const Answer next = answers_.top();
    answers_.pop();
    --in_flight_;
    tlm::tlm_phase phase = tlm::BEGIN_RESP;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    socket[next.initiator]->nb_transport_bw(*next.payload, phase, delay);
    next.payload->release();
  }
  if (!answers_.empty()) answer_event_.notify(answers_.top().at - sc_core::sc_time_stamp());
}

unsigned int DramController::transport_dbg(int, tlm::tlm_generic_payload& payload) {
  const std::uint64_t address = payload.get_address();
  if (address >= capacity_bytes()) return 0;
  const auto length = static_cast<unsigned int>(
      std::min<std::uint64_t>(payload.get_data_length(), capacity_bytes() - address));
  if (payload.is_read())
    store_.read(address, payload.get_data_ptr(), length);
  else if (payload.is_write())
    store_.write(address, payload.get_data_ptr(), length);
  else
    return 0;
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return length;
}

void DramController::on_command(const CommandRecord& record) {
  DramChannelStats& channel = stats_.channels[record.channel];
  ++channel.commands[static_cast<std::size_t>(record.command)];
  if (is_read(record.command) || is_write(record.command)) {
    channel.busy_cycles += memspec_.burst_cycles();
    ++stats_.bursts_by_region[record.region][is_write(record.command) ? 1 : 0];
  }
}

}  // namespace sgs
