// Random requests into a channel, its commands into the independent checker.
#include "tests/modules/dram/random_commands.h"

#include <random>
#include <vector>

#include "modules/dram/arrival_order_channel.h"
#include "modules/dram/queued_channel.h"

namespace sgs::test {

namespace {

// Phases of a few hundred requests, each with its own habits.
class RequestSource {
 public:
  RequestSource(const Memspec& memspec, const DramConfig& config, std::uint64_t seed)
      : memspec_(memspec), ranks_(config.ranks), random_(seed) {}

  ChannelRequest next(std::uint64_t& gap_cycles) {
    if (left_ == 0) new_phase();
    --left_;
    const Memspec::Organisation& o = memspec_.organisation;
    ChannelRequest r;
    r.direction = below(100) < writes_ ? Direction::kWrite : Direction::kRead;
    r.urgent = r.direction == Direction::kRead && below(100) < urgent_;
    r.rank = below(ranks_);
    r.bank = below(banks_);
    r.row = below(rows_) * 7 % o.rows;
    const std::uint32_t per_row = memspec_.bursts_per_row();
    r.burst = below(per_row);
    r.bursts = std::min(per_row - r.burst, 1 + below(longest_));
    gap_cycles = gap_ == 0 ? 0 : below(gap_);
    if (below(400) == 0) gap_cycles = below(3 * memspec_.timing_cycles.refi);
    return r;
  }

 private:
  std::uint32_t below(std::uint32_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(random_);
  }
  void new_phase() {
    left_ = 50 + below(400);
    writes_ = below(4) * 33;
    urgent_ = below(3) * 10;
    banks_ = below(2) == 0 ? memspec_.organisation.banks : 1 + below(2);
    rows_ = below(2) == 0 ? 2 : memspec_.organisation.rows;
    longest_ = below(2) == 0 ? 1 : 9;
    const std::uint32_t gaps[] = {0, 8, 40, 300};
    gap_ = gaps[below(4)];
  }

  const Memspec& memspec_;
  const std::uint32_t ranks_;
  std::mt19937_64 random_;
  std::uint32_t left_ = 0, writes_ = 0, urgent_ = 0, banks_ = 1, rows_ = 1, longest_ = 1, gap_ = 0;
};

}  // namespace

RandomRun run_queued(const DramConfig& config, std::uint64_t commands, std::uint64_t seed) {
  const Memspec memspec = load_memspec(config.memspec);
  TraceChecker checker(memspec, CommandTraceHeader::of(config));
  QueuedChannel channel(config, memspec, 0, checker);
  RequestSource source(memspec, config, seed);
  RandomRun run;
  std::uint64_t cycle = 0;
  QueuedChannel::Completion completion;
  while (checker.checked() < commands) {
    std::uint64_t gap = 0;
    const ChannelRequest request = source.next(gap);
    cycle += gap;
    channel.advance(cycle);
    while (channel.full(request)) channel.advance(cycle = channel.next_decision() + 1);
    channel.push(request, cycle);
    ++run.pushed;
    while (channel.take_completion(cycle, completion)) ++run.served;
  }
  while (!channel.empty()) channel.advance(channel.next_decision() + 1);
  channel.advance(cycle + 1000000);
  while (channel.take_completion(kNever, completion)) ++run.served;
  run.commands = checker.checked();
  if (checker.first()) run.violation = checker.first()->text();
  return run;
}

RandomRun run_arrival_order(const DramConfig& config, std::uint64_t commands, std::uint64_t seed) {
  const Memspec memspec = load_memspec(config.memspec);
  TraceChecker checker(memspec, CommandTraceHeader::of(config));
  ArrivalOrderChannel channel(config, memspec, 0, checker);
  RequestSource source(memspec, config, seed);
  RandomRun run;
  std::uint64_t cycle = 0;
  std::vector<std::uint64_t> done(16, 0);  // the window of a port: the oldest must be back
  while (checker.checked() < commands) {
    std::uint64_t gap = 0;
    const ChannelRequest request = source.next(gap);
    std::uint64_t& slot = done[run.pushed++ % done.size()];
    cycle = std::max(cycle + gap, slot);
    slot = channel.serve(request, cycle);
    ++run.served;
  }
  channel.finish(cycle + 1000000);
  run.commands = checker.checked();
  if (checker.first()) run.violation = checker.first()->text();
  return run;
}

DramConfig random_config(std::uint32_t index) {
  const std::vector<std::string> memspecs = shipped_memspecs();
  std::mt19937 random(index);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  DramConfig c;
  c.memspec = memspecs[index % memspecs.size()];
  c.channels = 1;
  c.ranks = 1u << below(2);
  c.mapping = "row:rank:bank:group:column:channel";
  c.write_latency_set = below(2) ? WriteLatencySet::kA : WriteLatencySet::kB;
  c.read_strobe = below(2) ? ReadStrobe::kMin : ReadStrobe::kMax;
  c.scheduler = below(4) ? SchedulerKind::kFrFcfs : SchedulerKind::kFcfs;
  c.age_cap_cycles = below(2) ? 100 : 2000;
  c.page_policy = static_cast<PagePolicyKind>(below(3));
  c.read_queue_entries = 1 + below(40);
  c.write_queue_entries = 2 + below(40);
  c.write_high_watermark = 1 + below(c.write_queue_entries);
  c.write_low_watermark = below(c.write_high_watermark);
  c.front_end_ns = below(2) * 5;
  c.back_end_ns = below(3) * 10;
  c.refresh = below(8) == 0 ? RefreshMode::kOff
                            : (below(2) ? RefreshMode::kAllBank : RefreshMode::kPerBank);
  const std::uint32_t most = load_memspec(c.memspec).refresh_postpone_limit;
  c.refresh_postpone_max = static_cast<std::int32_t>(below(most + 2)) - 1;
  c.power_down_idle_cycles = below(2) * (1 + below(200));
  c.self_refresh_idle_cycles = below(2) * (c.power_down_idle_cycles + 1 + below(3000));
  return c;
}

}  // namespace sgs::test
