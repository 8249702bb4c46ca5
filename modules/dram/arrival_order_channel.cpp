// A channel that serves requests in the order of their arrival.
#include "modules/dram/arrival_order_channel.h"

#include <algorithm>

namespace sgs {

namespace {
// Commands that are looked at for a collision lie within this many cycles of each other.
constexpr std::size_t kCommandBusSlots = 8192;
}  // namespace

ArrivalOrderChannel::ArrivalOrderChannel(const DramConfig& config, const Memspec& memspec,
                                         std::uint8_t channel, CommandSink& sink)
    : channel_(channel),
      path_(config, memspec),
      sink_(sink),
      device_(memspec, DerivedTiming(memspec, config.write_latency_set, config.read_strobe),
              config.ranks),
      outcome_(std::size_t{config.ranks} * memspec.organisation.banks, RowOutcome::kMiss),
      shapes_(command_shapes(memspec.command_bus)),
      taken_(memspec.command_bus.buses, std::vector<std::uint64_t>(kCommandBusSlots, kNever)) {
  for (std::uint32_t rank = 0; rank < config.ranks; ++rank)
    maintenance_.emplace_back(config, memspec, rank);
}

std::uint64_t ArrivalOrderChannel::serve(const ChannelRequest& request, std::uint64_t arrival) {
  const std::uint64_t cycle = arrival + path_.front_end;
  maintain(cycle);
  wake(request.rank, cycle);
  open(request, cycle);
  RowOutcome& outcome = outcome_[request.rank * device_.banks() + request.bank];
  const bool reads = request.direction == Direction::kRead;
  const Command command = reads ? Command::kRead : Command::kWrite;
  std::uint64_t at = cycle;
  for (std::uint32_t i = 0; i < request.bursts; ++i) {
    const std::uint64_t earliest = device_.earliest(
        reads ? RequestCommand::kRead : RequestCommand::kWrite, request.rank, request.bank);
    at = issue(command, request, request.burst + i, std::max(cycle + lead_of(command), earliest));
    rows_.count(outcome);
    outcome = RowOutcome::kHit;
  }
  last_column_ = std::max(last_column_, at);
  maintenance_[request.rank].on_waiting(std::uint64_t{1} << request.bank, cycle);
  hand_out_before(arrival);
  return at + (reads ? device_.derived().read_data_end : device_.derived().write_data_end) +
         path_.back_end(request.direction);
}

void ArrivalOrderChannel::finish(std::uint64_t cycle) {
  maintain(cycle);
  hand_out_before(cycle);
}

void ArrivalOrderChannel::maintain(std::uint64_t cycle) {
  const std::uint64_t busy_until = std::max(cycle, last_column_);
  while (true) {
    // The ranks' wishes in the order of time: slots of the command bus are taken in that order.
    Candidate first;
    for (const RankMaintenance& rank : maintenance_) {
      Candidate next = rank.next(device_, kNever, maintained_until_);
      if (next.cycle != kNever) next.cycle = std::max(next.cycle, maintained_until_);
      const bool allowed = next.cycle < cycle || rank.refresh_due() <= busy_until;
      if (allowed && next.cycle < first.cycle) first = next;
    }
    if (first.cycle == kNever) return;
    ChannelRequest none;
    none.rank = first.rank;
    none.bank = first.bank;
    maintained_until_ = issue(first.command, none, 0, first.cycle) + 1;
  }
}

void ArrivalOrderChannel::wake(std::uint32_t rank, std::uint64_t cycle) {
  while (!maintenance_[rank].powered_up()) {
    const Candidate exit = maintenance_[rank].next(device_, cycle, 0);
    ChannelRequest none;
    none.rank = rank;
    // What it wished for earlier had to wait for the other rank's maintenance.
    issue(exit.command, none, 0, std::max(exit.cycle, cycle));
  }
}

void ArrivalOrderChannel::open(const ChannelRequest& r, std::uint64_t cycle) {
  const std::uint32_t open_row = device_.open_row(r.rank, r.bank);
  if (open_row == r.row) return;
  RowOutcome& outcome = outcome_[r.rank * device_.banks() + r.bank];
  outcome = RowOutcome::kMiss;
  if (open_row != kNoRow) {
    outcome = RowOutcome::kConflict;
    issue(Command::kPrecharge, r, 0,
          std::max(cycle + lead_of(Command::kPrecharge),
                   device_.earliest(RequestCommand::kPrecharge, r.rank, r.bank)));
  }
  issue(Command::kActivate, r, 0,
        std::max(cycle + lead_of(Command::kActivate),
                 device_.earliest(RequestCommand::kActivate, r.rank, r.bank)));
}

std::uint64_t ArrivalOrderChannel::issue(Command command, const ChannelRequest& request,
                                         std::uint32_t burst, std::uint64_t earliest) {
  const CommandShape& shape = shapes_[static_cast<std::size_t>(command)];
  CommandRecord record{take_command_bus(shape, earliest),
                       command,
                       channel_,
                       static_cast<std::uint8_t>(request.rank),
                       static_cast<std::uint8_t>(request.bank),
                       request.region,
                       command == Command::kActivate ? request.row : 0,
                       burst};
  device_.issue(record);
  maintenance_[request.rank].on_command(command, record.cycle);
  pending_.push(record);
  return record.cycle;
}

std::uint64_t ArrivalOrderChannel::take_command_bus(const CommandShape& shape, std::uint64_t last) {
  std::vector<std::uint64_t>& taken = taken_[shape.bus];
  const auto any_taken = [&](std::uint64_t first) {
    for (std::uint64_t left = shape.cycles; left != 0; left &= left - 1) {
      const std::uint64_t cycle = first + static_cast<std::uint64_t>(__builtin_ctzll(left));
      if (taken[cycle % kCommandBusSlots] == cycle) return true;
    }
    return false;
  };
  std::uint64_t first = std::max<std::uint64_t>(last, shape.lead) - shape.lead;
  while (any_taken(first)) ++first;
  for (std::uint64_t left = shape.cycles; left != 0; left &= left - 1) {
    const std::uint64_t cycle = first + static_cast<std::uint64_t>(__builtin_ctzll(left));
    taken[cycle % kCommandBusSlots] = cycle;
  }
  return first + shape.lead;
}

void ArrivalOrderChannel::hand_out_before(std::uint64_t cycle) {
  while (!pending_.empty() && pending_.top().cycle < cycle) {
    sink_.on_command(pending_.top());
    pending_.pop();
  }
}

}  // namespace sgs
