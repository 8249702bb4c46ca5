// How a fitting goes: a table on standard output and the same as CSV; on a terminal a line between.
#pragma once

#include <chrono>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "testbench/command_line/command_line.h"

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

// Pictures of test views as a fitting goes, beside their photographs: for somebody to look at.
struct TestPictures {
  std::string folder;            // empty: none
  std::vector<int> views = {0};  // numbers of test views

  void add_to(CommandLine& line);
  void add_to(OutputPlan& plan) const;
  // view_N_photograph.png, before `background`. test: loaded. Throws InputError for a view that is
  // not there.
  void write_photographs(const Photographs& test, const glm::vec3& background) const;
  // Writes view_N_step_STEPS.png of what it is shown.
  PictureSeen behind(int steps) const;

 private:
  std::string file(int view, const std::string& what) const;
};

}  // namespace sgs
