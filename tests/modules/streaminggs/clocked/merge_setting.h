// The merge unit and its clocked reference with the same before and behind them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "testbench/units/merge_run.h"
#include "tests/modules/clocked/surroundings.h"
#include "tests/modules/streaminggs/clocked/clocked_merge.h"

namespace sgs::test {

// A group is finished as `finishing` says, or a cycle after as many keys as the plan says were
// taken.
struct MergeSetting {
  struct Gaps {
    std::uint32_t one_in = 1, longest = 1;
  };
  tb::MergePlan plan;
  PortHardware port;
  Finishing finishing = {};
  std::uint64_t seed = 1;
  Gaps in = {}, out = {};

  Pace pace_in(std::uint64_t sorter) const { return {seed + sorter, in.one_in, in.longest}; }
  Pace pace_out() const { return {seed + 1000, out.one_in, out.longest}; }
};

// In final order. Depths are not negative.
inline std::uint64_t key_of(float depth, std::uint32_t slot) {
  return std::uint64_t{__builtin_bit_cast(std::uint32_t, depth)} << 32U | slot;
}
constexpr std::uint64_t kMergeMark = ~std::uint64_t{0};
inline std::uint64_t what_of_key(const FineCandidate& key) {
  return key.mark == Mark::kNone ? key_of(key.depth, key.slot) : kMergeMark;
}

// [sorter] what it hands on.
inline std::vector<std::vector<FineCandidate>> inputs_of(const tb::MergePlan& plan) {
  std::vector<std::vector<FineCandidate>> inputs(plan.sorters);
  std::uint32_t number = 0;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    const std::vector<tb::MergeVisit>& visits = plan.groups[g].visits;
    for (std::size_t v = 0; v <= visits.size(); ++v, ++number) {
      std::vector<FineCandidate>& to = inputs[number % plan.sorters];
      FineCandidate end;
      end.group = g;
      end.visit = number;
      end.mark = v < visits.size() ? Mark::kEndOfVisit : Mark::kEndOfGroup;
      end.release_below = v < visits.size() ? visits[v].release_below : tb::kInfinity;
      if (v < visits.size()) {
        for (const tb::MergeKey& key : visits[v].keys) to.push_back(tb::candidate(g, number, key));
      }
      to.push_back(end);
    }
  }
  return inputs;
}

// Groups and keys of the last one, of what was taken.
class TakenGroups {
 public:
  explicit TakenGroups(const tb::MergePlan& plan) : plan_(plan), seen_from_(plan.groups.size()) {}

  std::size_t ended() const { return group_; }
  bool all() const { return group_ == plan_.groups.size(); }
  // Whether the group is finished with it.
  bool take(std::uint64_t what, std::uint64_t now) {
    if (what == kMergeMark) {
      ++group_;
      keys_ = 0;
      return false;
    }
    if (++keys_ != plan_.groups[group_].saturates_after) return false;
    seen_from_[group_] = now + plan_.feedback_cycles;
    return true;
  }
  bool seen(std::uint32_t group, std::uint64_t now) const {
    return seen_from_[group] > 0 && now >= seen_from_[group];
  }

 private:
  const tb::MergePlan& plan_;
  std::size_t group_ = 0;
  std::uint64_t keys_ = 0;
  std::vector<std::uint64_t> seen_from_;  // [group] cycle; 0: not finished
};

// Takes from the FIFOs in turn, as rendering does behind them; then `also`.
inline void run_merge_unit(
    tb::Case& test, Takings& taken, const MergeSetting& setting,
    const std::function<void(const MergeUnit&)>& also = [](const MergeUnit&) {}) {
  const tb::MergePlan& plan = setting.plan;
  tb::MergeRun run(test, bench_of(setting.port, tb::still_bench(plan).memory_bytes), plan);
  add_finishing(run.bench, setting.finishing, plan.groups.size(), run.finished.channel);
  const std::vector<std::vector<FineCandidate>> inputs = inputs_of(plan);
  for (std::uint32_t s = 0; s < plan.sorters; ++s) {
    add_source(run.bench, fmt::format("sorter{}", s), inputs[s], setting.pace_in(s),
               *run.inputs[s]);
  }
  run.bench.add_thread("reader", [&](Activity& activity) {
    const Pace pace = setting.pace_out();
    for (TakenGroups groups(plan); !groups.all();) {
      run.bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of_key(run.outputs[taken.size() % plan.hfus]->pop(activity));
      const std::uint64_t now = run.bench.clock().now_cycles();
      taken.push_back({now, what});
      const auto group = static_cast<std::uint32_t>(groups.ended());
      if (groups.take(what, now)) run.finished.finish(group);
    }
  });
  run.bench.run();
  also(run.unit);
}

template <class Heap>
Takings clocked_merge_unit(const MergeSetting& setting, Heap& heap) {
  const tb::MergePlan& plan = setting.plan;
  const RegionSpan spill = tb::merge_job(plan).spill;
  const MergeConfig& config = plan.config;
  ClockedMerge<Heap> unit(
      heap, config.cycles_per_operation, config.entries,
      {config.spill_runs, config.spill_block_entries, setting.port, spill.base, spill.bytes / 2});
  std::vector<ClockedFifo<MergeItem>> in, out;
  std::vector<ClockedSource<MergeItem>> sources;
  std::uint64_t number = 0;
  for (const std::vector<FineCandidate>& keys : inputs_of(plan)) {
    std::vector<MergeItem> items;
    for (const FineCandidate& key : keys) {
      const bool is_mark = key.mark != Mark::kNone;
      items.push_back({what_of_key(key), key.group, is_mark, key.mark == Mark::kEndOfGroup,
                       key_of(key.release_below, 0)});
    }
    sources.emplace_back(std::move(items), setting.pace_in(number++));
    in.emplace_back(plan.input_entries);
  }
  for (std::uint32_t h = 0; h < plan.hfus; ++h) out.emplace_back(plan.output_entries);
  ClockedSink<MergeItem> sink(setting.pace_out());
  TakenGroups groups(plan);
  for (std::uint64_t now = 0; !groups.all(); ++now) {
    const std::size_t before = sink.taken().size();
    sink.step(out[before % out.size()], now, [](const MergeItem& item) { return item.key; });
    if (sink.taken().size() > before) groups.take(sink.taken().back().what, now);
    unit.step(in, out, [&](std::uint32_t group) {
      return setting.finishing.seen(group, now) || groups.seen(group, now);
    });
    for (std::size_t s = 0; s < in.size(); ++s) sources[s].step(in[s]);
    for (ClockedFifo<MergeItem>& fifo : in) fifo.step();
    for (ClockedFifo<MergeItem>& fifo : out) fifo.step();
  }
  return sink.taken();
}

}  // namespace sgs::test
