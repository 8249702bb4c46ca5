// Runs the test cases of one testbench, each in a process of its own (SystemC elaborates once a
// process), and says PASS or FAIL.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"

namespace sgs::tb {

class Checks {
 public:
  void that(bool held, const std::string& what) {
    ++made_;
    if (held) return;
    constexpr std::uint64_t kPrintedFailures = 10;
    if (++failed_ <= kPrintedFailures) std::printf("  FAILED: %s\n", what.c_str());
  }

  template <class A, class B>
  void equal(const A& got, const B& expected, const std::string& what) {
    const bool held = got == expected;
    that(held, held ? std::string() : fmt::format("{}: {}, expected {}", what, got, expected));
  }

  std::uint64_t made() const { return made_; }
  std::uint64_t failed() const { return failed_; }

 private:
  std::uint64_t made_ = 0, failed_ = 0;
};

// The inputs of a case.
struct Case {
  Checks& checks;
  OutputFile* vcd;         // null: no waveform
  std::mt19937_64 random;  // seeded by the run's seed and the case
};

class CaseRunner {
 public:
  using Body = std::function<void(Case&)>;

  // program, purpose: for --help.
  CaseRunner(std::string program, std::string purpose);

  void add_directed(const std::string& name, Body body);
  // Run as often as --cases says, each with other random numbers; named "random 0", "random 1", ...
  void set_random(Body body) { random_ = std::move(body); }

  // Parses --seed, --cases, --case and --vcd, runs the cases. Exit status: kDone when all checks
  // held, kFailed, or kBadInput for bad arguments.
  int run(int argc, char* argv[]);

 private:
  struct Named {
    std::string name;
    Body body;
  };
  int run_all(std::uint64_t seed, std::uint64_t count, const std::string& only,
              const std::string& vcd_path);
  // Returns true if the case passed; adds its checks to the totals.
  bool run_one(const Named& named, std::uint64_t seed, OutputFile* vcd);

  const std::string program_, purpose_;
  std::vector<Named> directed_;
  Body random_;
  std::uint64_t checks_ = 0, failures_ = 0;
};

}  // namespace sgs::tb
