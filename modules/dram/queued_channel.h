// One channel's controller: queues, policies, refresh and power states, on the device's tables.
//
// It knows no SystemC and no clock ticks. Between two arrivals its course is fixed, so it is worked
// out only when somebody looks: advance(c) takes all decisions that fall before cycle c. All
// arrivals of a cycle are therefore known to that cycle's decision, in whatever order they came.
// The command that can begin first goes first, at equal cycles those of urgent requests before all
// others, columns before row commands, older requests before younger.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "modules/dram/channel_request.h"
#include "modules/dram/command_bus.h"
#include "modules/dram/device_timing.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/page_policy.h"
#include "modules/dram/path_latency.h"
#include "modules/dram/rank_maintenance.h"
#include "modules/dram/request_queue.h"
#include "modules/dram/ring_queue.h"
#include "modules/dram/row_counts.h"
#include "modules/dram/scheduling_policy.h"

namespace sgs {

// Entries of a channel's read queue for urgent reads alone, which find room whoever else waits:
// what a port has in flight lies on all channels.
constexpr std::uint32_t kUrgentEntries = 4;

class QueuedChannel {
 public:
  QueuedChannel(const DramConfig& config, const Memspec& memspec, std::uint8_t channel,
                CommandSink& sink);

  bool full(const ChannelRequest& request) const { return queue(request.direction).full(request); }
  bool empty() const { return reads_.empty() && writes_.empty(); }

  // Takes a request that arrives at `cycle`; all before it must have been advanced to. Not when
  // full.
  void push(const ChannelRequest& request, std::uint64_t cycle);

  // Takes all decisions that fall before `cycle`.
  void advance(std::uint64_t cycle);

  // As RankMaintenance has it, of all ranks.
  void rest(bool rests, std::uint64_t cycle);

  // No request completes before this cycle, whatever arrives; kNever with nothing to do.
  std::uint64_t next_completion();
  // No queue entry becomes free before this cycle.
  std::uint64_t next_decision();

  // Requests that are answered by `cycle`: their last datum has been transferred, and has come
  // back. Earliest first. Null: no more.
  struct Completion {
    std::uint64_t cycle;
    void* owner;
  };
  bool take_completion(std::uint64_t cycle, Completion& completion);

  const RowCounts& rows() const { return rows_; }
  std::uint64_t forwarded_reads() const { return forwarded_reads_; }

 private:
  // The request that a bank serves for one direction; kept until the bank's requests or row change.
  struct Work {
    std::int32_t entry = RequestQueue::kNone;
    RequestCommand command = RequestCommand::kActivate;
    bool settled = true;
    bool column = false;
    bool urgent = false;
    std::uint32_t rank = 0;
    std::uint32_t bank = 0;           // within the rank
    std::uint32_t wasted_within = 0;  // cycles before a refresh in which the command is of no use
    std::uint64_t ready = 0;
    std::uint64_t order = 0;
  };

  // A command and the request that it is for. Less is better: the earlier first cycle, at equal
  // ones an urgent request, then a column before a row command, then the older request.
  struct Choice {
    // cycle * 4, plus 2 when not urgent, plus 1 when no column
    std::uint64_t cycle_and_kind = ~std::uint64_t{0};
    std::uint64_t order = 0;
    std::uint32_t flat_bank = 0;
  };

  RequestQueue& queue(Direction d) { return d == Direction::kRead ? reads_ : writes_; }
  const RequestQueue& queue(Direction d) const { return d == Direction::kRead ? reads_ : writes_; }
  Direction wanted_direction() const;
  void revise_best(const ChannelRequest& added, std::uint32_t bank);
  bool aged(const RequestQueue& queue) const;
  const Candidate& best();
  void adopt(const Choice& choice);
  Work work_of(const RequestQueue& queue, std::uint32_t bank) const;
  std::vector<Work>& works(Direction d) { return works_[static_cast<std::size_t>(d)]; }
  void renew_work(std::uint32_t bank);
  // A rank's first request comes through the front end.
  void let_through(std::uint32_t rank);
  // Since when requests that are through the front end wait for a rank, or will; kNever: none does.
  std::uint64_t wanted_from(std::uint32_t rank) const;
  // Tells the rank's maintenance which banks these wait for; true if that may change the choice.
  bool tell_maintenance(std::uint32_t rank, std::uint64_t cycle);
  Choice best_of(std::uint64_t banks, Choice best);
  void consider_maintenance();
  void issue_best();
  void issue_maintenance(const Candidate& candidate);
  void send(const Candidate& candidate, Command command, const ChannelRequest* request);
  void hand_on(const CommandRecord& record);
  void hand_on_before(std::uint64_t cycle);
  void issue_column(const Candidate& candidate, std::int32_t entry);
  void complete(const ChannelRequest& request, std::uint64_t cycle);
  void tell_queues(std::uint32_t bank, std::uint32_t open_row);

  const std::uint8_t channel_;
  const PathLatency path_;
  const std::uint32_t high_watermark_;
  const std::uint32_t low_watermark_;
  const std::uint64_t age_cap_;
  CommandSink& sink_;
  DeviceTiming device_;
  std::vector<RankMaintenance> maintenance_;
  std::unique_ptr<SchedulingPolicy> scheduling_;
  std::unique_ptr<PagePolicy> paging_;
  RequestQueue reads_;
  RequestQueue writes_;

  Direction direction_ = Direction::kRead;   // of the last request's command
  Direction considered_ = Direction::kRead;  // for the choice at hand; a look must change nothing
  std::uint64_t clock_ = 0;                  // no command begins before
  CommandBus bus_;
  // Commands whose last cycle is yet to come, in its order; others may come before.
  std::vector<CommandRecord> begun_;
  // Arrival of the last request: state that it changes, as the wanted direction, is not decided
  // before.
  std::uint64_t arrived_ = 0;
  std::uint64_t next_order_ = 0;
  struct Arrival {
    std::uint64_t ready;
    std::uint32_t bank;  // counted over all ranks
  };
  // Refresh and the low-power states do not look at a request before it is through the front end.
  struct RankRequests {
    RingQueue<Arrival> on_the_way;
    std::uint32_t waiting = 0;
    std::uint64_t wanted_from = 0;  // while any waits
  };
  std::vector<RankRequests> rank_requests_;
  std::vector<std::uint32_t> waiting_;      // by bank: requests that are through
  std::uint64_t waiting_banks_ = 0;         // a bit each
  std::vector<RowOutcome> outcome_;         // by bank: of the next column
  std::array<std::vector<Work>, 2> works_;  // by direction and bank
  bool best_known_ = false;
  Candidate best_;                                 // its cycle is the first one of the command
  std::int32_t best_entry_ = RequestQueue::kNone;  // none: maintenance
  Choice best_choice_;                             // choice among requests
  RingQueue<Completion> read_completions_;
  RingQueue<Completion> write_completions_;
  RingQueue<Completion> forwarded_;
  std::uint64_t forwarded_reads_ = 0;
  // Writes of an order below come before all reads: one that waits wants bytes of them. 0: none.
  std::uint64_t writes_due_ = 0;
  RowCounts rows_;
};

}  // namespace sgs
