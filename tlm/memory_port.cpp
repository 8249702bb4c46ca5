// One initiator of memory traffic, used from a unit's SC_THREADs.
#include "tlm/memory_port.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace sgs {

namespace {
constexpr std::size_t kFirstSlots = 64;
}  // namespace

SramUse unanswered_writes(const char* name, const char* memory, const MemoryPortConfig& config,
                          std::uint32_t longest_bytes) {
  return sram_use(name, memory,
                  {{std::min(config.max_writes, config.max_outstanding), "unanswered"},
                   {std::min(config.max_transaction_bytes, longest_bytes), "B"}},
                  {8 * std::min({kPortBytes, config.max_transaction_bytes, longest_bytes})},
                  kOneOfEach);
}

SramUse outstanding_table(const char* memory, const MemoryPortConfig& config) {
  constexpr std::uint32_t kEntryBytes = 8;
  return sram_use(kOutstandingTable, memory,
                  {{config.max_outstanding, "transactions"}, {kEntryBytes, "B"}},
                  {8 * kEntryBytes}, kOneOfEach);
}

MemoryPort::MemoryPort(const sc_core::sc_module_name& name, const MemoryPortConfig& config,
                       const sc_core::sc_time& cycle)
    : sc_module(name),
      socket("socket"),
      config_(config),
      cycle_(cycle),
      delayed_(this, &MemoryPort::on_phase),
      slots_(kFirstSlots) {
  if (config.max_transaction_bytes == 0 || config.max_outstanding == 0 || config.max_writes == 0)
    throw std::invalid_argument(fmt::format(
        "{}: max_transaction_bytes {}, max_outstanding {} and max_writes {} must be at least 1",
        this->name(), config.max_transaction_bytes, config.max_outstanding, config.max_writes));
  socket.register_nb_transport_bw(this, &MemoryPort::nb_transport_bw);
}

MemoryPort::Ticket MemoryPort::read(std::uint64_t address, void* into, std::uint32_t bytes,
                                    std::uint8_t region) {
  bytes_read_ += bytes;
  return start(tlm::TLM_READ_COMMAND, address, static_cast<std::uint8_t*>(into), bytes, region);
}

MemoryPort::Ticket MemoryPort::write(std::uint64_t address, const void* from, std::uint32_t bytes,
                                     std::uint8_t region) {
  bytes_written_ += bytes;
  words_written_ += (bytes + kPortBytes - 1) / kPortBytes;
  // start() only reads through this pointer when the command is a write.
  auto* data = static_cast<std::uint8_t*>(const_cast<void*>(from));
  return start(tlm::TLM_WRITE_COMMAND, address, data, bytes, region);
}

bool MemoryPort::done(Ticket ticket) const {
  return ticket < oldest_ || slot(ticket).remaining == 0;
}

void MemoryPort::wait_for(Ticket ticket) {
  while (!done(ticket)) {
    slot(ticket).waited_for = true;
    sc_core::wait(answered_);
  }
}

void MemoryPort::wait_all() {
  while (outstanding_ > 0) {
    waiting_for_all_ = true;
    sc_core::wait(drained_);
  }
}

MemoryPort::Ticket MemoryPort::start(tlm::tlm_command command, std::uint64_t address,
                                     std::uint8_t* data, std::uint32_t bytes, std::uint8_t region) {
  const std::uint64_t step = config_.max_transaction_bytes;
  const std::uint64_t end = address + bytes;
  const std::uint64_t count = bytes == 0 ? 0 : (end - 1) / step - address / step + 1;
  const Ticket ticket = new_ticket(static_cast<std::uint32_t>(count));
  while (address < end) {
    const auto length =
        static_cast<std::uint32_t>(std::min(end, (address / step + 1) * step) - address);
    PooledPayload& payload = pool_.acquire();
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_length(length);
    payload.set_streaming_width(length);
    payload.memory().region = region;
    payload.memory().tag = ticket;
    if (command == tlm::TLM_WRITE_COMMAND) {
      payload.set_data_ptr(payload.buffer(length));
      std::memcpy(payload.get_data_ptr(), data, length);
    } else {
      payload.set_data_ptr(data);
    }
    send(payload);
    address += length;
    data += length;
  }
  return ticket;
}

MemoryPort::Ticket MemoryPort::new_ticket(std::uint32_t transactions) {
  while (oldest_ < next_ && done(oldest_)) ++oldest_;
  if (next_ - oldest_ == slots_.size()) {
    std::vector<Slot> wider(2 * slots_.size());
    for (Ticket t = oldest_; t < next_; ++t) wider[t & (wider.size() - 1)] = slot(t);
    slots_ = std::move(wider);
  }
  slot(next_) = Slot{transactions, false};
  return next_++;
}

void MemoryPort::send(PooledPayload& payload) {
  if (const sc_core::sc_time& now = sc_core::sc_time_stamp(); now < next_leaves_) {
    sc_core::wait(next_leaves_ - now);
  }
  while (!has_room(payload.is_write())) {
    ++waiting_for_room_;
    sc_core::wait(room_);
    --waiting_for_room_;
  }
  next_leaves_ = sc_core::sc_time_stamp() + cycle_;
  ++outstanding_;
  writes_outstanding_ += payload.is_write() ? 1 : 0;
  ++transactions_;
  bytes_outstanding_ += payload.get_data_length();
  request_ = &payload;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_ACCEPTED) return;
  if (delay != sc_core::SC_ZERO_TIME) sc_core::wait(delay);
  if (status == tlm::TLM_COMPLETED) {
    finish(payload);
  } else {
    on_phase(payload, phase);
  }
}

void MemoryPort::trace(sc_core::sc_trace_file* file) const {
  sc_core::sc_trace(file, bytes_outstanding_, std::string(name()) + ".bytes_outstanding");
}

void MemoryPort::request_taken(const tlm::tlm_generic_payload& payload) {
  if (request_ != &payload) return;
  request_ = nullptr;
  if (waiting_for_room_ > 0) room_.notify(sc_core::SC_ZERO_TIME);
}

void MemoryPort::finish(tlm::tlm_generic_payload& payload) {
  check_response(payload);
  request_taken(payload);  // an answer implies END_REQ
  --outstanding_;
  writes_outstanding_ -= payload.is_write() ? 1 : 0;
  bytes_outstanding_ -= payload.get_data_length();
  Slot& s = slot(static_cast<PooledPayload&>(payload).memory().tag);
  --s.remaining;
  if (s.remaining == 0 && s.waited_for) answered_.notify(sc_core::SC_ZERO_TIME);
  if (waiting_for_room_ > 0) room_.notify(sc_core::SC_ZERO_TIME);
  if (outstanding_ == 0 && waiting_for_all_) {
    waiting_for_all_ = false;
    drained_.notify(sc_core::SC_ZERO_TIME);
  }
  payload.release();
}

void MemoryPort::check_response(const tlm::tlm_generic_payload& payload) const {
  if (payload.is_response_ok()) return;
  SC_REPORT_ERROR(
      "/sgs/memory_port",
      fmt::format("{}: {} of {} bytes at {:#x}: {}", name(), payload.is_read() ? "read" : "write",
                  payload.get_data_length(), payload.get_address(), payload.get_response_string())
          .c_str());
}

void MemoryPort::on_phase(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase) {
  if (phase == tlm::END_REQ) {
    request_taken(payload);
    return;
  }
  if (phase != tlm::BEGIN_RESP) {
    SC_REPORT_ERROR("/sgs/memory_port", "a phase that the base protocol does not know");
    return;
  }
  tlm::tlm_phase end = tlm::END_RESP;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  socket->nb_transport_fw(payload, end, delay);
  finish(payload);
}

tlm::tlm_sync_enum MemoryPort::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                               tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  if (delay != sc_core::SC_ZERO_TIME) {
    delayed_.notify(payload, phase, delay);
    return tlm::TLM_ACCEPTED;
  }
  if (phase == tlm::END_REQ) {
    request_taken(payload);
    return tlm::TLM_ACCEPTED;
  }
  // Finishing at once spares the END_RESP call.
  finish(payload);
  phase = tlm::END_RESP;
  return tlm::TLM_COMPLETED;
}

}  // namespace sgs
