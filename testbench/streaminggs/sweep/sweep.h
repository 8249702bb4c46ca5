// A sweep: tasks that wait, run and are answered, each result kept as soon as it is there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/process/child_process.h"
#include "testbench/streaminggs/sweep/sweep_points.h"
#include "testbench/streaminggs/sweep/sweep_results.h"
#include "testbench/streaminggs/sweep/sweep_simulations.h"
#include "testbench/streaminggs/sweep/sweep_task.h"

namespace sgs {

// Points that come line by line while others are simulated.

// A point says what it differs in; what is longer is no text that anybody wrote.
constexpr std::size_t kLongestLineBytes = 1'000'000;

// Reads points from a file descriptor, which poll() can wait for.
class PointStream {
 public:
  explicit PointStream(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const { return descriptor_; }
  bool ended() const { return ended_; }

  // Reads once, what is there or, where nothing is, when it comes: the points of the lines that are
  // complete. A line that is none is a refused point: who sent it waits for an answer. One longer
  // than kLongestLineBytes is refused when so much of it has come, and the rest of it dropped.
  std::vector<SweepPoint> receive();

 private:
  void take(std::string_view piece, std::vector<SweepPoint>& points);
  void end_line(std::vector<SweepPoint>& points);
  std::string place() const;

  const int descriptor_;
  bool ended_ = false;
  std::string line_;       // as much of it as has come
  bool too_long_ = false;  // and refused: what still comes of it is dropped
  int number_ = 1;         // the line's number
};

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
