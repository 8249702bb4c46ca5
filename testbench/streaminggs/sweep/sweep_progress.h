// How far a sweep is, on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "algorithm/memory/second_half.h"
#include "testbench/streaminggs/run/progress.h"
#include "testbench/streaminggs/sweep/sweep.h"

namespace sgs {

class SweepProgress {
 public:
  SweepProgress() : line_(std::in_place), began_(Clock::now()) {}

  void say(const SweepCounts& counts) const;
  void say(Codebook codebook, std::uint32_t iteration, double error) const;

  // Wipes it.
  void end() { line_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<ProgressLine> line_;
  const Clock::time_point began_;
};

}  // namespace sgs
