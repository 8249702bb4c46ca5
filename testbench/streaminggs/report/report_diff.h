// Differences between two runs of `simulate`, each with its share of the whole.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "testbench/streaminggs/report/reported_run.h"

namespace sgs {

// A key of both configurations; "(chosen)" behind a value that the model chose, "(N used)" behind
// the size of a memory that is not used whole.
struct ConfigChange {
  std::string key, a, b;
};

// The change of one part. Where it has several copies, busy and waited cycles are the mean of its
// copies, all else their sum.
struct PartChange {
  std::string name;
  double a = 0, b = 0;
  double copies_a = 0, copies_b = 0;
  double of_whole = 0;  // b - a, over the whole of A's quantity: of cycles, the frame's
};

// The mean of a view, over those that both runs have.
struct QuantityChange {
  Quantity quantity = Quantity::kBusy;
  double a = 0, b = 0;
  std::vector<PartChange> parts;  // largest change of the whole first
  std::size_t equal = 0;          // parts that are alike in both

  double ratio() const { return a > 0 ? b / a - 1 : 0; }  // change of the whole, as a share of A's
};

struct ReportDiff {
  bool streams = false;             // of frames back to back, each run one view
  std::vector<std::string> unlike;  // facts that make them runs of something else, a sentence each
  std::vector<std::pair<const ReportedView*, const ReportedView*>> views;  // in both
  std::vector<ConfigChange> config;
  std::vector<std::string> keys_of_a, keys_of_b;  // keys that only one has: of other machines
  std::size_t equal_keys = 0;
  bool clocks_differ = false;
  bool without_memory = false;  // joules of both: the memory's are known of neither
  // Time, then the largest change first. No joules where the memory's are part of one run alone.
  std::vector<QuantityChange> quantities;
};

// Both outlive it. Throws InputError where they have no view in common, or one is of frames back to
// back alone.
ReportDiff diff_runs(const ReportedRun& a, const ReportedRun& b);

}  // namespace sgs
