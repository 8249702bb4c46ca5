// How a fitting goes: a table on standard output and the same as CSV; on a terminal a line between.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/train/evaluation.h"
#include "algorithm/train/fitting.h"

namespace sgs {

// Quality of the current scene in the test views; `more` has a number for each further column of
// the log.
struct Look {
  Quality test;
  std::vector<double> more;
};

// A column of the log beside those that every fitting has.
struct LogColumn {
  const char* csv;
  const char* heading;  // in the table, up to 10 letters
};

class FittingLog {
 public:
  // The log and the duration, in seconds, of earlier runs.
  struct Earlier {
    std::string csv;
    double seconds = 0;
  };

  // steps: in all.
  FittingLog(int steps, std::vector<LogColumn> more, Earlier earlier);

  // After each step; rewrites the line.
  void tell(const FittingStep& step, std::size_t gaussians);
  // After so many steps; loss: of the last one, none before the first.
  void add(int done, std::optional<double> loss, std::size_t gaussians, const Look& look);
  // After the last step: says so if the test views are worse than before the first.
  void end() const;
  // step, seconds, loss, Gaussians, PSNR and SSIM of the test views, further columns.
  const std::string& csv() const { return csv_; }
  double seconds() const { return before_s_ + own_seconds(); }  // all runs together

 private:
  double own_seconds() const;

  const int steps_;
  const bool terminal_;
  std::string csv_;
  const double before_s_;  // duration of earlier runs
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  int first_step_ = -1;                  // this run's first
  std::optional<double> first_psnr_db_;  // before the first step, where this run saw it
  std::optional<double> test_psnr_db_;   // at the last look
};

}  // namespace sgs
