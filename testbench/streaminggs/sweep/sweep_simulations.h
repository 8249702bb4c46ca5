// Simulations of a sweep's tasks: each in a child of its own, which shares what its neighbours need
// as well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "algorithm/vq/quantise.h"
#include "testbench/cost/technology.h"
#include "testbench/process/child_process.h"
#include "testbench/streaminggs/report/run_report.h"
#include "testbench/streaminggs/run/recently_used.h"
#include "testbench/streaminggs/run/view_result.h"
#include "testbench/streaminggs/sweep/sweep_task.h"

namespace sgs {

// The frame that a machine must give, and what it is worth.
struct ExpectedFrame {
  GoldenFrame golden;
  std::vector<std::byte> bytes, right_bytes;  // the frame buffers'
  JudgedFrame judged;
  std::optional<RightEye> right;
};

// Host memory that they use, in bytes.
std::uint64_t size_bytes(const ReferencePictures& pictures);
std::uint64_t size_bytes(const ExpectedFrame& expected);

class SweepSimulations {
 public:
  // progress: of codebooks that are made; what it throws, start() does.
  SweepSimulations(const SweepPlan& plan, Technology technology, RunFacts facts,
                   VqProgress progress);

  // Stores the scene and draws its pictures, where that was not done yet, and starts the simulation
  // of a task that is not refused. Its result is the line of sweep_record.h. Throws InputError when
  // the task is refused, as result() may.
  std::unique_ptr<ChildProcess> start(const SweepTask& task);

 private:
  const SweepPlan& plan_;
  const Technology technology_;
  const RunFacts facts_;
  const VqProgress progress_;
  std::set<std::string> doubts_;  // of clocks, each said once
  RecentlyUsed<PreparedScene> scenes_;
  RecentlyUsed<ReferencePictures> references_;
  RecentlyUsed<ExpectedFrame> expected_;
};

}  // namespace sgs
