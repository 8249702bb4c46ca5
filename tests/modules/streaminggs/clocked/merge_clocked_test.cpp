// The merge unit against its clocked reference.
#include <catch2/catch.hpp>

#include "modules/streaminggs/exact_config.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/merge_setting.h"

namespace sgs::test {
namespace {

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

MergeSetting setting_of(const MergeWorkload& load, std::uint64_t seed) {
  return {plan_of(load, seed),
          load.port(),
          load.finishing,
          seed,
          {load.in_one_in, load.in_longest},
          {load.out_one_in, load.out_longest}};
}
void run_merge(tb::Case& test, Takings& taken, const MergeWorkload& load, std::uint64_t seed) {
  run_merge_unit(test, taken, setting_of(load, seed));
}
Takings clocked_merge(const MergeWorkload& load, std::uint64_t seed) {
  ClockedHeap heap;
  return clocked_merge_unit(setting_of(load, seed), heap);
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
