// How training goes: a table on standard output and the same as CSV; on a terminal a line between.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "algorithm/train/evaluation.h"
#include "algorithm/train/trainer.h"

namespace sgs {

class TrainingLog {
 public:
  // steps: in all. csv: what an earlier run wrote, whose time goes on.
  TrainingLog(int steps, std::string csv);

  // After each step; rewrites the line.
  void tell(const Trainer::Step& step, std::size_t gaussians);
  // With the pictures of all test views.
  void add(const Trainer::Step& step, std::size_t gaussians, const Quality& test);
  // step, seconds, loss, Gaussians, PSNR and SSIM of the test views.
  const std::string& csv() const { return csv_; }

 private:
  double seconds() const;

  const int steps_;
  const bool terminal_;
  std::string csv_;
  double before_s_ = 0;  // that earlier runs took
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  int first_step_ = -1;  // of this run
};

}  // namespace sgs
