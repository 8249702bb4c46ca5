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
                  {{config.max_outstanding, "transactions"}, {kEntryBytes, "B"}}, {8 * kEntryBytes},
                  kOneOfEach);
}

MemoryPort::MemoryPort(const sc_core::sc_module_name& name, const MemoryPortConfig& config,
                       const sc_core::sc_time& cycle)
    : sc_module(name),
      socket("socket"),
      config_(config),
      cycle_(cycle),
      delayed_(this, &MemoryPort::on_phase),
      arriving_(this, &MemoryPort::on_arrival),
      slots_(kFirstSlots) {
  if (config.max_transaction_bytes == 0 || config.max_outstanding == 0 || config.max_writes == 0 ||
      config.width_bytes == 0)
    throw std::invalid_argument(
        fmt::format("{}: max_transaction_bytes {}, max_outstanding {}, max_writes {} and "
                    "width_bytes {} must be at least 1",
                    this->name(), config.max_transaction_bytes, config.max_outstanding,
                    config.max_writes, config.width_bytes));
  socket.register_nb_transport_bw(this, &MemoryPort::nb_transport_bw);
  SC_METHOD(launch);
  dont_initialize();
  sensitive << at_target_;
  SC_METHOD(take_answers);
  dont_initialize();
  sensitive << at_port_;
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

void MemoryPort::wait_before(Ticket ticket) {
  for (Ticket t = oldest_; t < ticket; ++t) wait_for(t);
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
  if (part_) bytes_of_parts_[*part_] += bytes;
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
    payload.memory().urgent = config_.urgent;
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
  const std::uint64_t cycles = payload.is_write() ? words(payload.get_data_length()) : 1;
  next_leaves_ = sc_core::sc_time_stamp() + static_cast<double>(cycles) * cycle_;
  ++outstanding_;
  writes_outstanding_ += payload.is_write() ? 1 : 0;
  ++transactions_;
  bytes_outstanding_ += payload.get_data_length();
  // The memory takes a write when it has its last word.
  const std::uint64_t way = config_.path_cycles + cycles - 1;
  leaving_.push_back({&payload, sc_core::sc_time_stamp() + static_cast<double>(way) * cycle_});
  launch();
}

void MemoryPort::launch() {
  if (request_ != nullptr || leaving_.empty()) return;
  const Leaving first = leaving_.front();
  if (const sc_core::sc_time& now = sc_core::sc_time_stamp(); now < first.due) {
    at_target_.notify(first.due - now);
    return;
  }
  leaving_.pop_front();
  PooledPayload& payload = *first.payload;
  request_ = &payload;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
  if (status == tlm::TLM_ACCEPTED) return;
  if (status == tlm::TLM_COMPLETED) phase = tlm::END_RESP;  // which on_phase() need not send
  if (delay == sc_core::SC_ZERO_TIME) {
    on_phase(payload, phase);
  } else {
    delayed_.notify(payload, phase, delay);
  }
}

void MemoryPort::trace(sc_core::sc_trace_file* file) const {
  sc_core::sc_trace(file, bytes_outstanding_, std::string(name()) + ".bytes_outstanding");
}

void MemoryPort::request_taken(const tlm::tlm_generic_payload& payload) {
  if (request_ != &payload) return;
  request_ = nullptr;
  if (!leaving_.empty()) at_target_.notify(sc_core::SC_ZERO_TIME);
  if (waiting_for_room_ > 0) room_.notify(sc_core::SC_ZERO_TIME);
}

// The memory has the answer. Its words take the path behind those of the answers before: they come
// from the memory more slowly than the path takes them, so that one that finds it free is there
// with its last word.
void MemoryPort::arrive(tlm::tlm_generic_payload& payload) {
  request_taken(payload);  // an answer implies END_REQ
  const sc_core::sc_time way = static_cast<double>(config_.path_cycles) * cycle_;
  if (way == sc_core::SC_ZERO_TIME) {
    finish(payload);
    return;
  }
  const Ticket ticket = static_cast<PooledPayload&>(payload).memory().tag;
  answers_.emplace(std::tuple(sc_core::sc_time_stamp() + way, ticket, payload.get_address()),
                   &payload);
  at_port_.notify(way);
}

void MemoryPort::take_answers() {
  const sc_core::sc_time now = sc_core::sc_time_stamp();
  while (!answers_.empty() && std::get<0>(answers_.begin()->first) <= now) {
    tlm::tlm_generic_payload& payload = *answers_.begin()->second;
    answers_.erase(answers_.begin());
    if (payload.is_read()) {
      const auto cycles = static_cast<double>(words(payload.get_data_length()));
      last_arrived_ = std::max(now, last_arrived_ + cycles * cycle_);
    }
    if (payload.is_write() || last_arrived_ == now) {
      finish(payload);
      continue;
    }
    tlm::tlm_phase phase = tlm::END_RESP;
    arriving_.notify(payload, phase, last_arrived_ - now);
  }
  if (!answers_.empty()) at_port_.notify(std::get<0>(answers_.begin()->first) - now);
}

void MemoryPort::finish(tlm::tlm_generic_payload& payload) {
  check_response(payload);
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
  if (phase == tlm::END_RESP) {
    arrive(payload);
    return;
  }
  if (phase != tlm::BEGIN_RESP) {
    SC_REPORT_ERROR("/sgs/memory_port", "a phase that the base protocol does not know");
    return;
  }
  tlm::tlm_phase end = tlm::END_RESP;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  socket->nb_transport_fw(payload, end, delay);
  arrive(payload);
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
  // Ending it at once spares the END_RESP call.
  arrive(payload);
  phase = tlm::END_RESP;
  return tlm::TLM_COMPLETED;
}

}  // namespace sgs
