// A sweep: tasks that wait, run and are answered, each result kept as soon as it is there.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "testbench/process/child_process.h"
#include "testbench/streaminggs/sweep/point_stream.h"
#include "testbench/streaminggs/sweep/sweep_results.h"
#include "testbench/streaminggs/sweep/sweep_simulations.h"
#include "testbench/streaminggs/sweep/sweep_task.h"

namespace sgs {

struct SweepCounts {
  std::uint64_t asked = 0;  // all that are known
  std::uint64_t done = 0, refused = 0, failed = 0;
  std::uint64_t kept = 0;       // results of earlier sweeps among these three
  std::uint64_t simulated = 0;  // by this sweep, to whatever end
  std::uint64_t answered() const { return done + refused + failed; }
};

struct SweepAnswer {
  const SweepTask& task;
  const std::string line;    // as in sweep_record.h
  const std::string status;  // in that line
  const bool kept;           // by an earlier sweep
};

class Sweep {
 public:
  // side_by_side: simulations at a time.
  Sweep(SweepSimulations& simulations, SweepResults& results, std::uint32_t side_by_side)
      : simulations_(simulations), results_(results), side_by_side_(side_by_side) {}

  // Told of each task that has a result.
  std::function<void(const SweepAnswer&)> answer;
  // Told whenever something has changed, and some times a second.
  std::function<void(const SweepCounts&)> progress;
  // True if the sweep is to stop; asked some times a second.
  std::function<bool()> stop;

  void add(std::vector<SweepTask> tasks);

  // Simulates what waits and, where there is a stream, what comes, until nothing can come any more.
  // False where it was stopped: what was running then has no result. Throws std::runtime_error when
  // results cannot be kept.
  bool run(PointStream* stream,
           const std::function<std::vector<SweepTask>(const SweepPoint&)>& plan);

  const SweepCounts& counts() const { return counts_; }

 private:
  struct Running {
    SweepTask task;
    std::unique_ptr<ChildProcess> child;
  };
  bool has_result(const std::string& key) const;
  bool may_plan() const;
  void start_waiting();
  void wait_for_something(PointStream* stream);
  void finish(Running& running);
  void keep(const SweepTask& task, const std::string& line);
  void keep_refused(const SweepTask& task, const std::string& why);
  void keep_failed(const SweepTask& task, const std::string& why);
  void tell(const SweepAnswer& to);

  SweepSimulations& simulations_;
  SweepResults& results_;
  const std::uint32_t side_by_side_;
  SweepCounts counts_;
  std::deque<SweepTask> waiting_;
  std::vector<Running> running_;
  std::map<std::string, std::vector<SweepTask>> same_;  // as one that waits or runs, by key
  std::set<std::string> failed_now_;  // keys that are not tried again by this sweep
  std::deque<SweepPoint> arrived_;    // out of the stream, not planned yet
};

}  // namespace sgs
