// The memory as a non-blocking TLM-2.0 target: phases, back-pressure, answers.
#include "modules/dram/dram_controller.h"

#include <fmt/format.h>

#include <algorithm>

#include "modules/dram/byte_store.h"
#include "tlm/memory_extension.h"

namespace sgs {

namespace {
DramConfig checked(const DramConfig& config) {
  config.validate();
  return config;
}
}  // namespace

DramController::DramController(const sc_core::sc_module_name& name, const DramConfig& config)
    : sc_module(name),
      socket("socket"),
      config_(checked(config)),
      memspec_(load_memspec(config.memspec)),
      mapping_(config_, memspec_),
      clock_period_(memspec_.clock_period_ns, sc_core::SC_NS),
      store_(mapping_.capacity_bytes()),
      commands_(memspec_, config_),
      delayed_(this, &DramController::on_delayed) {
  socket.register_nb_transport_fw(this, &DramController::nb_transport_fw);
  socket.register_b_transport(this, &DramController::b_transport);
  socket.register_transport_dbg(this, &DramController::transport_dbg);
  for (std::uint32_t c = 0; c < config_.buses(memspec_); ++c) {
    channels_.emplace_back(config_, memspec_, static_cast<std::uint8_t>(c), commands_);
    sc_core::sc_spawn_options options;
    options.spawn_method();
    options.dont_initialize();
    options.set_sensitivity(&channels_.back().wake);
    sc_core::sc_spawn([this, c] { on_wake(c); }, fmt::format("channel_{}", c).c_str(), &options);
  }
  SC_METHOD(send_answers);
  sensitive << answers_waiting_;
  dont_initialize();
  SC_METHOD(retry_all);
  sensitive << room_;
  dont_initialize();
}

void DramController::end_of_elaboration() { initiators_.resize(socket.size()); }

bool DramController::idle() const {
  return open_transactions_ == 0 && (transport_ != Transport::kBlocking || busy_until_ <= now());
}

void DramController::rest(bool rests) {
  if (transport_ == Transport::kBlocking) return;
  for (Channel& channel : channels_) channel.queued.rest(rests, now());
}

std::uint64_t DramController::cycle_of(const sc_core::sc_time& time) const {
  return (time.value() + clock_period_.value() - 1) / clock_period_.value();
}

sc_core::sc_time DramController::time_of(std::uint64_t cycle) const {
  return sc_core::sc_time::from_value(cycle * clock_period_.value());
}

bool DramController::uses(Transport transport) {
  if (transport_ == Transport::kUnused) transport_ = transport;
  if (transport_ == transport) return true;
  SC_REPORT_ERROR("/sgs/dram",
                  fmt::format("{}: blocking and non-blocking requests in one run", name()).c_str());
  return false;
}

DramController::Transaction& DramController::new_transaction(int initiator,
                                                             tlm::tlm_generic_payload& payload,
                                                             const sc_core::sc_time& arrival) {
  if (free_transactions_.empty()) {
    transactions_.emplace_back();
    free_transactions_.push_back(&transactions_.back());
  }
  Transaction& t = *free_transactions_.back();
  free_transactions_.pop_back();
  const auto* memory = payload.get_extension<MemoryExtension>();
  t = Transaction{};
  t.payload = &payload;
  t.initiator = initiator;
  t.direction = payload.is_read() ? Direction::kRead : Direction::kWrite;
  t.region = memory ? memory->region : std::uint8_t{0};
  t.urgent = memory && memory->urgent && payload.is_read();
  t.masked = payload.get_byte_enable_ptr() != nullptr;
  t.begin = payload.get_address();
  t.next = t.begin & ~std::uint64_t{mapping_.burst_bytes() - 1};
  t.end = t.begin + payload.get_data_length();
  t.arrival = cycle_of(arrival);
  commands_.counts.traffic.add(memory ? memory->requester : std::uint8_t{0}, t.region, t.direction,
                               payload.get_data_length());
  return t;
}

ChannelRequest DramController::next_request(Transaction& t, std::uint32_t& channel) const {
  const std::uint64_t run = mapping_.run_bytes();
  const std::uint32_t burst = mapping_.burst_bytes();
  const std::uint64_t stop = std::min(t.end, (t.next & ~(run - 1)) + run);
  const DramAddress place = mapping_.decode(t.next);
  channel = place.channel;
  ChannelRequest request;
  request.direction = t.direction;
  request.region = t.region;
  request.urgent = t.urgent;
  request.rank = place.rank;
  request.bank = place.bank;
  request.row = place.row;
  request.burst = place.burst;
  request.bursts = static_cast<std::uint32_t>((stop - t.next + burst - 1) / burst);
  request.masked = t.masked || t.next < t.begin || stop % burst != 0;
  request.owner = &t;
  t.next = stop;
  return request;
}

tlm::tlm_sync_enum DramController::nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                                   tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  if (phase == tlm::END_RESP) {
    Initiator& from = initiators_[static_cast<std::size_t>(initiator)];
    from.response_open = false;
    if (!from.answers.empty()) answers_waiting_.notify(sc_core::SC_ZERO_TIME);
    return tlm::TLM_COMPLETED;
  }
  if (!uses(Transport::kNonBlocking)) return tlm::TLM_COMPLETED;
  if (delay == sc_core::SC_ZERO_TIME) return begin_request(initiator, payload, phase);
  auto* note = payload.get_extension<ArrivingFrom>();
  if (note == nullptr) payload.set_extension(note = new ArrivingFrom);
  note->initiator = initiator;
  payload.acquire();  // the queue of delayed requests keeps a bare pointer
  delayed_.notify(payload, phase, delay);
  return tlm::TLM_ACCEPTED;
}

tlm::tlm_sync_enum DramController::begin_request(int initiator, tlm::tlm_generic_payload& payload,
                                                 tlm::tlm_phase& phase) {
  Initiator& from = initiators_[static_cast<std::size_t>(initiator)];
  if (from.feeding != nullptr) {
    SC_REPORT_ERROR("/sgs/dram",
                    fmt::format("{}: BEGIN_REQ before END_REQ of the one before", name()).c_str());
    return tlm::TLM_COMPLETED;
  }
  if (!move_bytes(payload, store_)) return tlm::TLM_COMPLETED;
  Transaction& t = new_transaction(initiator, payload, sc_core::sc_time_stamp());
  if (open_transactions_++ == 0) busy_from_ = t.arrival;
  if (!feed(t, t.arrival)) {
    payload.acquire();
    return tlm::TLM_ACCEPTED;
  }
  if (t.direction == Direction::kWrite && config_.posted_writes) {
    t.payload = nullptr;
    return tlm::TLM_COMPLETED;
  }
  payload.acquire();
  phase = tlm::END_REQ;
  return tlm::TLM_UPDATED;
}

void DramController::on_delayed(tlm::tlm_generic_payload& payload, const tlm::tlm_phase&) {
  const int initiator = payload.get_extension<ArrivingFrom>()->initiator;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  const tlm::tlm_sync_enum status = begin_request(initiator, payload, phase);
  if (status == tlm::TLM_UPDATED) {
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    socket[initiator]->nb_transport_bw(payload, phase, delay);
  } else if (status == tlm::TLM_COMPLETED) {
    payload.acquire();
    answer(initiator, payload);
  }
  payload.release();
}

bool DramController::feed(Transaction& t, std::uint64_t cycle) {
  while (t.next < t.end) {
    const std::uint64_t before = t.next;
    std::uint32_t index = 0;
    const ChannelRequest request = next_request(t, index);
    Channel& channel = channels_[index];
    channel.queued.advance(cycle);
    if (channel.queued.full(request)) {
      t.next = before;
      Initiator& from = initiators_[static_cast<std::size_t>(t.initiator)];
      from.feeding = &t;
      from.waits_for = index;
      ++channel.blocked;
      schedule(index);
      return false;
    }
    ++t.remaining;
    channel.queued.push(request, cycle);
    schedule(index);
  }
  return true;
}

void DramController::schedule(std::uint32_t index) {
  Channel& channel = channels_[index];
  std::uint64_t wanted = channel.queued.next_completion();
  if (channel.blocked > 0) {
    const std::uint64_t decision = channel.queued.next_decision();
    if (decision != kNever) wanted = std::min(wanted, decision + 1);
  }
  if (wanted >= channel.wake_at) return;
  channel.wake_at = wanted;
  channel.wake.notify(time_of(wanted) - sc_core::sc_time_stamp());
}

void DramController::on_wake(std::uint32_t index) {
  Channel& channel = channels_[index];
  const std::uint64_t cycle = now();
  channel.wake_at = kNever;
  channel.queued.advance(cycle);
  QueuedChannel::Completion completion;
  while (channel.queued.take_completion(cycle, completion)) {
    Transaction& t = *static_cast<Transaction*>(completion.owner);
    t.done = std::max(t.done, completion.cycle);
    if (--t.remaining == 0 && t.next >= t.end) finish(t);
  }
  schedule(index);
  if (channel.blocked == 0) return;
  channel.may_have_room = true;
  room_.notify(sc_core::SC_ZERO_TIME);
}

void DramController::retry_all() {
  for (std::uint32_t index = 0; index < channels_.size(); ++index) {
    if (!channels_[index].may_have_room) continue;
    channels_[index].may_have_room = false;
    retry_blocked(index, now());
    schedule(index);
  }
}

void DramController::retry_blocked(std::uint32_t index, std::uint64_t cycle) {
  // Whoever comes after the last one served is first: no initiator starves.
  const std::size_t count = initiators_.size();
  const std::size_t first = next_retry_;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (first + k) % count;
    Initiator& from = initiators_[i];
    if (from.feeding == nullptr || from.waits_for != index) continue;
    Transaction& t = *from.feeding;
    from.feeding = nullptr;
    --channels_[index].blocked;
    if (!feed(t, cycle)) continue;
    next_retry_ = (i + 1) % count;
    tlm::tlm_generic_payload& payload = *t.payload;
    if (t.direction == Direction::kWrite && config_.posted_writes) {
      t.payload = nullptr;
      answer(t.initiator, payload);
    } else {
      tlm::tlm_phase phase = tlm::END_REQ;
      sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
      socket[t.initiator]->nb_transport_bw(payload, phase, delay);
    }
  }
}

void DramController::finish(Transaction& t) {
  (t.direction == Direction::kRead ? commands_.counts.read_latency_cycles
                                   : commands_.counts.write_latency_cycles)
      .add(t.done - t.arrival);
  if (--open_transactions_ == 0) {
    commands_.counts.busy_cycles += t.done - busy_from_;
    busy_until_ = t.done;
  }
  tlm::tlm_generic_payload* payload = t.payload;
  const int initiator = t.initiator;
  free_transactions_.push_back(&t);
  if (payload != nullptr) answer(initiator, *payload);
}

void DramController::answer(int initiator, tlm::tlm_generic_payload& payload) {
  Initiator& to = initiators_[static_cast<std::size_t>(initiator)];
  if (to.response_open) {
    to.answers.push(&payload);
    return;
  }
  tlm::tlm_phase phase = tlm::BEGIN_RESP;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  to.response_open = true;
  const tlm::tlm_sync_enum status = socket[initiator]->nb_transport_bw(payload, phase, delay);
  if (status == tlm::TLM_COMPLETED || (status == tlm::TLM_UPDATED && phase == tlm::END_RESP))
    to.response_open = false;
  payload.release();
}

void DramController::send_answers() {
  for (std::size_t i = 0; i < initiators_.size(); ++i)
    while (!initiators_[i].response_open && !initiators_[i].answers.empty()) {
      tlm::tlm_generic_payload& payload = *initiators_[i].answers.front();
      initiators_[i].answers.pop();
      answer(static_cast<int>(i), payload);
    }
}

}  // namespace sgs
