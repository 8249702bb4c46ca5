// The merge unit against its clocked reference.
#include <catch2/catch.hpp>

#include "modules/streaminggs/exact_config.h"
#include "testbench/units/merge_run.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_merge.h"

namespace sgs::test {
namespace {

constexpr std::uint64_t kMergeMark = ~std::uint64_t{0};

struct MergeWorkload {
  const char* name;
  std::uint32_t chunk = 16;  // slots of a visit
  std::uint32_t depths = 1000;
  std::uint32_t cycles_per_operation = 2;
  std::uint32_t in_one_in = 1, in_longest = 1, out_one_in = 1, out_longest = 1;
  std::uint32_t in_entries = 16, out_entries = 4, sorters = 1, hfus = 4;
  std::uint32_t entries = 512, spill_runs = 8, spill_block_entries = 8;
  std::uint32_t read_latency = 20, write_latency = 150;
  Finishing finishing = {};
  PortHardware port() const {
    return {preset_of<ExactConfig>("exact").port, read_latency, write_latency};
  }
};

tb::MergePlan plan_of(const MergeWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::MergePlan plan;
  plan.slots = 400;
  plan.config.cycles_per_operation = load.cycles_per_operation;
  plan.config.entries = load.entries;
  plan.config.spill_runs = load.spill_runs;
  plan.config.spill_block_entries = load.spill_block_entries;
  plan.sorters = load.sorters;
  plan.hfus = load.hfus;
  plan.input_entries = load.in_entries;
  plan.output_entries = load.out_entries;
  for (int g = 0; g < 3; ++g) {
    plan.groups.push_back(tb::random_group(random, plan, load.chunk, load.depths));
  }
  return plan;
}

// Depths are multiples of 0.5.
std::uint64_t depth_of(float depth) {
  return depth == tb::kInfinity ? kMergeMark >> 20U : static_cast<std::uint64_t>(2 * depth);
}
std::uint64_t key_of(float depth, std::uint32_t slot) { return depth_of(depth) << 16U | slot; }
std::uint64_t what_of_key(const FineCandidate& key) {
  return key.mark == Mark::kNone ? key_of(key.depth, key.slot) : kMergeMark;
}

// [sorter] what it hands on.
std::vector<std::vector<FineCandidate>> inputs_of(const tb::MergePlan& plan) {
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

// Until the marks of all groups are there.
bool all_released(const tb::MergePlan& plan, const Takings& taken) {
  const auto is_mark = [](const Taken& t) { return t.what == kMergeMark; };
  return static_cast<std::size_t>(std::count_if(taken.begin(), taken.end(), is_mark)) ==
         plan.groups.size();
}

// Takes from the FIFOs in turn, as rendering does behind them.
void run_merge(tb::Case& test, Takings& taken, const MergeWorkload& load, std::uint64_t seed) {
  const tb::MergePlan plan = plan_of(load, seed);
  tb::MergeRun run(test, bench_of(load.port(), tb::still_bench(plan).memory_bytes), plan);
  add_finishing(run.bench, load.finishing, plan.groups.size(), run.finished.channel);
  const std::vector<std::vector<FineCandidate>> inputs = inputs_of(plan);
  for (std::uint32_t s = 0; s < plan.sorters; ++s) {
    add_source(run.bench, fmt::format("sorter{}", s), inputs[s],
               {seed + s, load.in_one_in, load.in_longest}, *run.inputs[s]);
  }
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  run.bench.add_thread("reader", [&](Activity& activity) {
    while (!all_released(plan, taken)) {
      run.bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of_key(run.outputs[taken.size() % plan.hfus]->pop(activity));
      taken.push_back({run.bench.clock().now_cycles(), what});
    }
  });
  run.bench.run();
}

Takings clocked_merge(const MergeWorkload& load, std::uint64_t seed) {
  const tb::MergePlan plan = plan_of(load, seed);
  const RegionSpan spill = tb::merge_job(plan).spill;
  ClockedMerge unit(
      load.cycles_per_operation, load.entries,
      {load.spill_runs, load.spill_block_entries, load.port(), spill.base, spill.bytes / 2});
  std::vector<ClockedFifo<MergeItem>> in, out;
  std::vector<ClockedSource<MergeItem>> sources;
  std::uint64_t number = 0;
  for (const std::vector<FineCandidate>& keys : inputs_of(plan)) {
    std::vector<MergeItem> items;
    for (const FineCandidate& key : keys) {
      const bool is_mark = key.mark != Mark::kNone;
      items.push_back({what_of_key(key), key.group, is_mark, key.mark == Mark::kEndOfGroup,
                       depth_of(key.release_below) << 16U});
    }
    sources.emplace_back(std::move(items), Pace(seed + number++, load.in_one_in, load.in_longest));
    in.emplace_back(plan.input_entries);
  }
  for (std::uint32_t h = 0; h < plan.hfus; ++h) out.emplace_back(plan.output_entries);
  ClockedSink<MergeItem> sink({seed + 1000, load.out_one_in, load.out_longest});
  for (std::uint64_t now = 0; !all_released(plan, sink.taken()); ++now) {
    sink.step(out[sink.taken().size() % out.size()], now,
              [](const MergeItem& item) { return item.key; });
    unit.step(in, out, [&](std::uint32_t group) { return load.finishing.seen(group, now); });
    for (std::size_t s = 0; s < in.size(); ++s) sources[s].step(in[s]);
    for (ClockedFifo<MergeItem>& fifo : in) fifo.step();
    for (ClockedFifo<MergeItem>& fifo : out) fifo.step();
  }
  return sink.taken();
}

void compare(Comparison& table, const MergeWorkload& load) {
  table.workload(load, run_merge, clocked_merge);
}

TEST_CASE("clocked reference: merge unit") {
  Comparison table("merge unit");
  MergeWorkload finishing{"groups that finish", 16, 1000, 2, 4, 60};
  finishing.finishing.pitch = 2600;
  for (const MergeWorkload& load : {
           MergeWorkload{"light: visits of up to 3", 3},
           MergeWorkload{"heavy: visits of up to 16", 16},
           MergeWorkload{"few depths", 16, 5},
           MergeWorkload{"an operation every 3 cycles", 16, 1000, 3},
           MergeWorkload{"input stalled", 16, 1000, 2, 4, 60},
           MergeWorkload{"output stalled", 16, 1000, 2, 1, 1, 4, 60},
           MergeWorkload{"tiny buffers", 16, 1000, 2, 4, 20, 4, 20, 1, 1},
           MergeWorkload{"two sorting units, one HFU", 16, 1000, 2, 1, 1, 1, 1, 16, 4, 2, 1},
           finishing,
       }) {
    compare(table, load);
  }
}

TEST_CASE("clocked reference: merge unit that spills") {
  Comparison table("merge, spilling");
  MergeWorkload spilling{"64 keys wait"};
  spilling.entries = 64;
  const auto with = [&](const char* name, const auto& change) {
    MergeWorkload load = spilling;
    load.name = name;
    change(load);
    return load;
  };
  for (const MergeWorkload& load : {
           spilling,
           with("128 keys wait", [](MergeWorkload& l) { l.entries = 128; }),
           with("10 keys wait", [](MergeWorkload& l) { l.entries = 10; }),
           with("visits of up to 3", [](MergeWorkload& l) { l.chunk = 3; }),
           with("few depths", [](MergeWorkload& l) { l.depths = 5; }),
           with("an operation every 4 cycles",
                [](MergeWorkload& l) { l.cycles_per_operation = 4; }),
           with("2 runs", [](MergeWorkload& l) { l.spill_runs = 2; }),
           with("2 runs, 10 keys wait",
                [](MergeWorkload& l) {
                  l.spill_runs = 2;
                  l.entries = 10;
                }),
           with("blocks of a key", [](MergeWorkload& l) { l.spill_block_entries = 1; }),
           with("blocks of 3 keys", [](MergeWorkload& l) { l.spill_block_entries = 3; }),
           with("memory of 300 cycles", [](MergeWorkload& l) { l.read_latency = 300; }),
           with("memory that answers at once",
                [](MergeWorkload& l) { l.read_latency = l.write_latency = 1; }),
           with("input stalled",
                [](MergeWorkload& l) {
                  l.in_one_in = 4;
                  l.in_longest = 60;
                }),
           with("output stalled",
                [](MergeWorkload& l) {
                  l.out_one_in = 4;
                  l.out_longest = 60;
                }),
           with("tiny buffers",
                [](MergeWorkload& l) {
                  l.in_entries = l.out_entries = 1;
                  l.out_one_in = 4;
                  l.out_longest = 20;
                }),
           with("tiny buffers, blocks of 2 keys",
                [](MergeWorkload& l) {
                  l.out_entries = l.hfus = 1;
                  l.out_one_in = 4;
                  l.out_longest = 60;
                  l.spill_block_entries = 2;
                  l.read_latency = 60;
                }),
           with("two sorting units, one HFU",
                [](MergeWorkload& l) {
                  l.sorters = 2;
                  l.hfus = 1;
                }),
       }) {
    compare(table, load);
  }
}

}  // namespace
}  // namespace sgs::test
