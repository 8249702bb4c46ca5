// One channel's controller: decisions over queues, policies and maintenance.
#include "modules/dram/queued_channel.h"

#include <algorithm>

namespace sgs {

namespace {
constexpr std::uint64_t kNoChoice = ~std::uint64_t{0};

constexpr Command command_of(RequestCommand command) {
  constexpr std::array<Command, 4> kCommandOf = {Command::kActivate, Command::kRead,
                                                 Command::kWrite, Command::kPrecharge};
  return kCommandOf[static_cast<std::size_t>(command)];
}
}  // namespace

QueuedChannel::QueuedChannel(const DramConfig& config, const Memspec& memspec, std::uint8_t channel,
                             CommandSink& sink)
    : channel_(channel),
      path_(config, memspec),
      high_watermark_(config.write_high_watermark),
      low_watermark_(config.write_low_watermark),
      age_cap_(config.age_cap_cycles),
      sink_(sink),
      device_(memspec, DerivedTiming(memspec, config.write_latency_set, config.read_strobe),
              config.ranks),
      scheduling_(make_scheduling_policy(config)),
      paging_(make_page_policy(config, config.ranks * memspec.organisation.banks)),
      reads_(config.read_queue_entries, kUrgentEntries, config.ranks * memspec.organisation.banks),
      writes_(config.write_queue_entries, 0, config.ranks * memspec.organisation.banks),
      bus_(memspec.command_bus),
      rank_requests_(config.ranks),
      waiting_(std::size_t{config.ranks} * memspec.organisation.banks),
      outcome_(std::size_t{config.ranks} * memspec.organisation.banks, RowOutcome::kMiss) {
  for (std::vector<Work>& works : works_) works.resize(outcome_.size());
  for (std::uint32_t rank = 0; rank < config.ranks; ++rank)
    maintenance_.emplace_back(config, memspec, rank);
}

void QueuedChannel::push(const ChannelRequest& request, std::uint64_t cycle) {
  const std::uint32_t bank = request.rank * device_.banks() + request.bank;
  const std::uint64_t ready = cycle + path_.front_end;
  RequestQueue::Met met;
  if (request.direction == Direction::kRead) met = writes_.met_by(request, bank);
  if (met.whole) {
    ++forwarded_reads_;
    forwarded_.push({ready + 1 + path_.back_end_read, request.owner});
    return;
  }
  arrived_ = cycle;
  if (met.order_end > writes_due_) {
    writes_due_ = met.order_end;
    best_known_ = false;
  }
  RequestQueue::Entry entry;
  entry.request = request;
  entry.arrival = cycle;
  entry.ready = ready;
  entry.order = next_order_++;
  queue(request.direction).push(entry, bank, device_.open_row(request.rank, request.bank));
  // The first request of a rank wakes it.
  if (wanted_from(request.rank) == kNever) best_known_ = false;
  rank_requests_[request.rank].on_the_way.push({ready, bank});
  renew_work(bank);
  revise_best(request, bank);
}

void QueuedChannel::let_through(std::uint32_t rank) {
  RankRequests& requests = rank_requests_[rank];
  const Arrival arrival = requests.on_the_way.front();
  requests.on_the_way.pop();
  if (requests.waiting++ == 0) requests.wanted_from = arrival.ready;
  if (waiting_[arrival.bank]++ > 0) return;
  waiting_banks_ |= std::uint64_t{1} << arrival.bank;
  if (tell_maintenance(rank, arrival.ready)) best_known_ = false;
}

std::uint64_t QueuedChannel::wanted_from(std::uint32_t rank) const {
  const RankRequests& requests = rank_requests_[rank];
  if (requests.waiting > 0) return requests.wanted_from;
  return requests.on_the_way.empty() ? kNever : requests.on_the_way.front().ready;
}

bool QueuedChannel::tell_maintenance(std::uint32_t rank, std::uint64_t cycle) {
  const std::uint64_t banks = waiting_banks_ >> (rank * device_.banks());
  return maintenance_[rank].on_waiting(banks & (~std::uint64_t{0} >> (64 - device_.banks())),
                                       cycle);
}

void QueuedChannel::advance(std::uint64_t cycle) {
  while (best().cycle < cycle) issue_best();
  hand_on_before(cycle);
}

void QueuedChannel::rest(bool rests, std::uint64_t cycle) {
  advance(cycle);
  for (RankMaintenance& rank : maintenance_) rank.rest(rests, cycle);
  best_known_ = false;
}

std::uint64_t QueuedChannel::next_decision() { return empty() ? kNever : best().cycle; }

std::uint64_t QueuedChannel::next_completion() {
  std::uint64_t next = kNever;
  for (const RingQueue<Completion>* q : {&read_completions_, &write_completions_, &forwarded_})
    if (!q->empty()) next = std::min(next, q->front().cycle);
  if (next != kNever || empty()) return next;
  const DerivedTiming& d = device_.derived();
  return best().cycle + std::min(d.read_data_end, d.write_data_end);
}

bool QueuedChannel::take_completion(std::uint64_t cycle, Completion& completion) {
  RingQueue<Completion>* first = nullptr;
  for (RingQueue<Completion>* q : {&read_completions_, &write_completions_, &forwarded_})
    if (!q->empty() && (first == nullptr || q->front().cycle < first->front().cycle)) first = q;
  if (first == nullptr || first->front().cycle > cycle) return false;
  completion = first->front();
  first->pop();
  return true;
}

bool QueuedChannel::aged(const RequestQueue& queue) const {
  for (std::uint64_t left = queue.banks_in_use(); left != 0; left &= left - 1) {
    const auto bank = static_cast<std::uint32_t>(__builtin_ctzll(left));
    if (queue.entry(queue.oldest(bank)).ready + age_cap_ < clock_) return true;
  }
  return false;
}

Direction QueuedChannel::wanted_direction() const {
  if (writes_.empty()) return Direction::kRead;
  if (writes_due_ > 0) return Direction::kWrite;
  if (reads_.has_urgent()) return Direction::kRead;
  if (reads_.empty()) return Direction::kWrite;
  if (direction_ == Direction::kWrite)
    return writes_.size() > low_watermark_ || aged(writes_) ? Direction::kWrite : Direction::kRead;
  return writes_.size() >= high_watermark_ || (aged(writes_) && !aged(reads_)) ? Direction::kWrite
                                                                               : Direction::kRead;
}

const Candidate& QueuedChannel::best() {
  while (true) {
    if (!best_known_) {
      considered_ = wanted_direction();
      adopt(best_of(queue(considered_).banks_in_use(), Choice{}));
      consider_maintenance();
      best_known_ = true;
    }
    const auto through = std::find_if(
        rank_requests_.begin(), rank_requests_.end(), [this](const RankRequests& requests) {
          return !requests.on_the_way.empty() && requests.on_the_way.front().ready <= best_.cycle;
        });
    if (through == rank_requests_.end()) return best_;
    let_through(static_cast<std::uint32_t>(through - rank_requests_.begin()));
  }
}

void QueuedChannel::adopt(const Choice& choice) {
  best_choice_ = choice;
  best_ = Candidate{};
  best_entry_ = RequestQueue::kNone;
  if (choice.cycle_and_kind == kNoChoice) return;
  const Work& work = works(considered_)[choice.flat_bank];
  best_ = {choice.cycle_and_kind >> 2, command_of(work.command), work.rank, work.bank};
  best_entry_ = work.entry;
}

void QueuedChannel::revise_best(const ChannelRequest& added, std::uint32_t bank) {
  if (!best_known_) return;
  // One for the chosen bank may change that choice.
  const bool disturbs = best_entry_ == RequestQueue::kNone || best_choice_.flat_bank == bank;
  if (disturbs || wanted_direction() != considered_) {
    best_known_ = false;
  } else if (added.direction == considered_) {
    const Choice choice = best_of(std::uint64_t{1} << bank, best_choice_);
    if (choice.flat_bank == bank) adopt(choice);
  }
}

QueuedChannel::Work QueuedChannel::work_of(const RequestQueue& queue, std::uint32_t bank) const {
  Work work;
  if ((queue.banks_in_use() >> bank & 1) == 0) return work;
  work.entry = queue.oldest_urgent(bank);
  if (work.entry == RequestQueue::kNone) {
    work.settled = scheduling_->settled(queue, bank);
    work.entry = scheduling_->choose(queue, bank, clock_);
  }
  if (work.entry == RequestQueue::kNone) return work;
  const RequestQueue::Entry& entry = queue.entry(work.entry);
  const ChannelRequest& request = entry.request;
  const std::uint32_t open_row = device_.open_row(request.rank, request.bank);
  if (open_row == request.row)
    work.command =
        request.direction == Direction::kRead ? RequestCommand::kRead : RequestCommand::kWrite;
  else
    work.command = open_row == kNoRow ? RequestCommand::kActivate : RequestCommand::kPrecharge;
  if (work.command == RequestCommand::kActivate)
    work.wasted_within = bus_.shape(Command::kActivate).lead +
                         device_.derived().activate_to_column(request.direction);
  work.column = open_row == request.row;
  work.urgent = request.urgent;
  work.rank = request.rank;
  work.bank = request.bank;
  work.ready = entry.ready;
  work.order = entry.order;
  return work;
}

void QueuedChannel::renew_work(std::uint32_t bank) {
  works(Direction::kRead)[bank] = work_of(reads_, bank);
  works(Direction::kWrite)[bank] = work_of(writes_, bank);
}

QueuedChannel::Choice QueuedChannel::best_of(std::uint64_t banks, Choice best) {
  std::vector<Work>& works = this->works(considered_);
  const std::uint64_t from = std::max(clock_, arrived_);
  for (; banks != 0; banks &= banks - 1) {
    const auto flat_bank = static_cast<std::uint32_t>(__builtin_ctzll(banks));
    Work& work = works[flat_bank];
    if (!work.settled) work = work_of(queue(considered_), flat_bank);
    const CommandShape& shape = bus_.shape(command_of(work.command));
    const std::uint64_t last = std::max(device_.earliest_flat(work.command, work.rank, flat_bank),
                                        std::max(work.ready, from) + shape.lead);
    const std::uint64_t cycle = bus_.fit(shape, last - shape.lead);
    const bool possible =
        (work.entry != RequestQueue::kNone) &
        (cycle + work.wasted_within < maintenance_[work.rank].request_limit(work.bank));
    // One comparison of packed numbers: which bank wins is too random for a branch each.
    const std::uint64_t kind = (work.urgent ? 0U : 2U) | (work.column ? 0U : 1U);
    const std::uint64_t key = possible ? cycle << 2 | kind : kNoChoice;
    const bool better =
        (key < best.cycle_and_kind) | ((key == best.cycle_and_kind) & (work.order < best.order));
    best.cycle_and_kind = better ? key : best.cycle_and_kind;
    best.order = better ? work.order : best.order;
    best.flat_bank = better ? flat_bank : best.flat_bank;
  }
  return best;
}

void QueuedChannel::consider_maintenance() {
  for (std::size_t r = 0; r < maintenance_.size(); ++r) {
    const RankMaintenance& rank = maintenance_[r];
    const std::uint64_t wanted = wanted_from(static_cast<std::uint32_t>(r));
    if (!rank.may_act_by(best_.cycle, wanted, clock_)) continue;
    Candidate wish = rank.next(device_, wanted, clock_);
    if (wish.cycle == kNever) continue;
    wish.cycle = bus_.fit(bus_.shape(wish.command), std::max(wish.cycle, clock_));
    if (wish.cycle > best_.cycle) continue;
    best_ = wish;
    best_entry_ = RequestQueue::kNone;
  }
}

void QueuedChannel::issue_best() {
  Candidate c = best_;
  best_known_ = false;
  const CommandShape& shape = bus_.shape(c.command);
  bus_.take(shape, c.cycle);
  clock_ = bus_.separate() ? c.cycle : c.cycle + 1;
  c.cycle += shape.lead;
  if (best_entry_ == RequestQueue::kNone) return issue_maintenance(c);
  direction_ = considered_;
  if (is_read(c.command) || is_write(c.command)) return issue_column(c, best_entry_);
  const std::uint32_t flat_bank = c.rank * device_.banks() + c.bank;
  const ChannelRequest request = queue(direction_).entry(best_entry_).request;
  RowOutcome& outcome = outcome_[flat_bank];
  send(c, c.command, &request);
  if (c.command == Command::kActivate) {
    paging_->on_activate(flat_bank, request.row, outcome == RowOutcome::kConflict);
    if (outcome == RowOutcome::kHit) outcome = RowOutcome::kMiss;  // a refresh had closed the row
    tell_queues(flat_bank, request.row);
  } else {
    outcome = RowOutcome::kConflict;
    tell_queues(flat_bank, kNoRow);
  }
}

void QueuedChannel::issue_maintenance(const Candidate& c) {
  send(c, c.command, nullptr);
  if (c.command == Command::kPrecharge) tell_queues(c.rank * device_.banks() + c.bank, kNoRow);
  if (c.command == Command::kPrechargeAll)
    for (std::uint32_t b = 0; b < device_.banks(); ++b)
      tell_queues(c.rank * device_.banks() + b, kNoRow);
}

void QueuedChannel::issue_column(const Candidate& c, std::int32_t index) {
  const std::uint32_t flat_bank = c.rank * device_.banks() + c.bank;
  RequestQueue& active = queue(direction_);
  RequestQueue::Entry& entry = active.entry(index);
  if (!entry.begun && outcome_[flat_bank] == RowOutcome::kHit) paging_->on_hit(flat_bank);
  entry.begun = true;
  if (entry.request.bursts > 1) {
    send(c, c.command, &entry.request);
    ++entry.request.burst;
    --entry.request.bursts;
    return;
  }
  const ChannelRequest request = entry.request;
  active.remove(index, flat_bank);
  if (writes_due_ > 0 && (writes_.empty() || writes_.oldest_order() >= writes_due_)) {
    writes_due_ = 0;
  }
  --rank_requests_[c.rank].waiting;
  if (--waiting_[flat_bank] == 0) {
    waiting_banks_ &= ~(std::uint64_t{1} << flat_bank);
    tell_maintenance(c.rank, c.cycle + 1);
  }
  const bool more_hits = reads_.oldest_hit(flat_bank) != RequestQueue::kNone ||
                         writes_.oldest_hit(flat_bank) != RequestQueue::kNone;
  const bool close = paging_->close_after(flat_bank, more_hits);
  const bool read = direction_ == Direction::kRead;
  if (close) {
    send(c, read ? Command::kReadAuto : Command::kWriteAuto, &request);
    tell_queues(flat_bank, kNoRow);
    outcome_[flat_bank] = RowOutcome::kMiss;
  } else {
    send(c, c.command, &request);
    renew_work(flat_bank);
  }
  complete(request,
           c.cycle + (read ? device_.derived().read_data_end : device_.derived().write_data_end));
}

void QueuedChannel::send(const Candidate& c, Command command, const ChannelRequest* request) {
  const bool column = is_read(command) || is_write(command);
  const CommandRecord record{c.cycle,
                             command,
                             channel_,
                             static_cast<std::uint8_t>(c.rank),
                             static_cast<std::uint8_t>(c.bank),
                             request ? request->region : std::uint8_t{0},
                             command == Command::kActivate ? request->row : 0,
                             column ? request->burst : 0};
  if (column) {
    RowOutcome& outcome = outcome_[c.rank * device_.banks() + c.bank];
    rows_.count(outcome);
    outcome = RowOutcome::kHit;
  }
  device_.issue(record);
  maintenance_[c.rank].on_command(command, c.cycle);
  hand_on(record);
}

void QueuedChannel::hand_on(const CommandRecord& record) {
  const std::uint32_t lead = bus_.shape(record.command).lead;
  hand_on_before(record.cycle - lead + 1);
  if (lead == 0) return sink_.on_command(record);
  const auto later = [](const CommandRecord& a, const CommandRecord& b) {
    return a.cycle < b.cycle;
  };
  begun_.insert(std::upper_bound(begun_.begin(), begun_.end(), record, later), record);
}

void QueuedChannel::hand_on_before(std::uint64_t cycle) {
  std::size_t over = 0;
  for (; over < begun_.size() && begun_[over].cycle < cycle; ++over) sink_.on_command(begun_[over]);
  begun_.erase(begun_.begin(), begun_.begin() + static_cast<std::ptrdiff_t>(over));
}

void QueuedChannel::complete(const ChannelRequest& request, std::uint64_t cycle) {
  (request.direction == Direction::kRead ? read_completions_ : write_completions_)
      .push({cycle + path_.back_end(request.direction), request.owner});
}

void QueuedChannel::tell_queues(std::uint32_t bank, std::uint32_t open_row) {
  reads_.on_row(bank, open_row);
  writes_.on_row(bank, open_row);
  renew_work(bank);
}

}  // namespace sgs
