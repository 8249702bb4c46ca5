// A unit against its clocked reference, workload by workload.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "testbench/units/case_runner.h"
#include "tests/modules/clocked/surroundings.h"

namespace sgs::test {

constexpr int kSeeds = 5;                     // of each workload
constexpr double kMostDifferencePercent = 2;  // in cycles, of one run

// What the unit hands out, simulated in a process of its own. Throws std::runtime_error where a
// check of its bench fails.
Takings takings_of_unit(std::uint64_t seed, const std::function<void(tb::Case&, Takings&)>& run);

// Prints a line for each workload, and checks: the same things in the same order, each in the
// reference's cycle but for as many as a workload is known for, and the last of them within
// kMostDifferencePercent of it.
class Comparison {
 public:
  explicit Comparison(std::string unit) : unit_(std::move(unit)) {}
  ~Comparison();  // a line over all workloads
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  // run, reference: for a seed. most_elsewhere: that may come in another cycle, of all seeds.
  void workload(const std::string& name,
                const std::function<void(tb::Case&, Takings&, std::uint64_t)>& run,
                const std::function<Takings(std::uint64_t)>& reference,
                std::size_t most_elsewhere = 0);

 private:
  const std::string unit_;
  double sum_ = 0, worst_ = 0;  // per cent
  int runs_ = 0;
};

}  // namespace sgs::test
