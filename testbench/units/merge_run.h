// Runs of a merge unit under test, with everything around it.
#pragma once

#include <cstdint>
#include <limits>

#include "modules/streaminggs/merge/merge_unit.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/merge_plan.h"
#include "testbench/units/reported_groups.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kBytesOfKey = 32;  // depth, slot, centre, two carried words, reach

struct MergeRun {
  UnitBench bench;
  StreamingJob job;
  ReportedGroups finished;
  FinishedSubtiles mask;
  Fifos<FineCandidate> inputs, outputs;
  MergeUnit unit;

  MergeRun(Case& test, const BenchConfig& config, const MergePlan& plan);
};

// One thread a sorting unit: its visits, each with its mark; a group's end is a visit of its own.
void add_sorters(MergeRun& run, const MergePlan& plan);

// Takes the keys in turn, as rendering takes their splats, and checks their order.
void add_reader(MergeRun& run, const MergePlan& plan);

// A bench without stalls, with the memory that the plan needs.
BenchConfig still_bench(const MergePlan& plan);

// Simulates the plan and checks what comes out, cycles, bytes and accesses; then `also`.
void run_plan(
    Case& test, const BenchConfig& config, const MergePlan& plan,
    const std::function<void(MergeRun&)>& also = [](MergeRun&) {});

}  // namespace sgs::tb
