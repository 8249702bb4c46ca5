// Arguments, processes and the summary of a testbench.
#include "testbench/units/case_runner.h"

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <systemc>

#include "algorithm/files/input_error.h"
#include "testbench/command_line/program.h"
#include "testbench/process/child_process.h"
#include "tlm/no_banner.h"
#include "tlm/time_resolution.h"

namespace sgs::tb {

namespace {

constexpr unsigned kCaseSeconds = 120;  // units that chase each other forever are a failure too

struct Result {
  std::uint64_t made = 0, failed = 0;
};

// The bytes of a Result.
std::string run_case(const CaseRunner::Body& body, std::uint64_t seed, const std::string& name,
                     OutputFile* vcd) {
  ::alarm(kCaseSeconds);
  Checks checks;
  try {
    use_femtosecond_resolution();
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(std::hash<std::string>()(name))};
    Case test{checks, vcd, std::mt19937_64(mixed)};
    body(test);
  } catch (const sc_core::sc_report& report) {
    checks.that(false, fmt::format("{}: {}", report.get_msg_type(), report.get_msg()));
  } catch (const std::exception& error) {
    checks.that(false, error.what());
  }
  const Result result{checks.made(), checks.failed()};
  return {reinterpret_cast<const char*>(&result), sizeof result};
}

}  // namespace

CaseRunner::CaseRunner(std::string program, std::string purpose)
    : program_(std::move(program)), purpose_(std::move(purpose)) {}

void CaseRunner::add_directed(const std::string& name, Body body) {
  directed_.push_back({name, std::move(body)});
}

bool CaseRunner::run_one(const Named& named, std::uint64_t seed, OutputFile* vcd) {
  Result result;
  try {
    const std::string bytes = in_child([&] { return run_case(named.body, seed, named.name, vcd); });
    std::memcpy(&result, bytes.data(), sizeof result);
  } catch (const std::runtime_error& error) {
    std::printf("  FAILED: %s\n", error.what());
    ++result.failed;
  }
  if (result.made == 0) {
    std::printf("  FAILED: nothing was checked\n");
    ++result.failed;
  }
  checks_ += result.made;
  failures_ += result.failed;
  if (result.failed > 0)
    std::printf("%s: case '%s' failed\n", program_.c_str(), named.name.c_str());
  return result.failed == 0;
}

int CaseRunner::run(int argc, char* argv[]) {
  constexpr std::uint64_t kMost = 1'000'000'000;
  CommandLine line(program_, purpose_);
  std::uint64_t seed = 1, count = 100;
  std::string only, vcd_path;
  line.whole("--seed", seed, 0, kMostSeed, "of the random cases");
  line.whole("--cases", count, 0, kMost, "random cases, after the directed ones");
  line.file("--case", only, "run only the case of this name");
  line.file("--vcd", vcd_path, "write the waveform of the first case that runs");
  return run_program(line, argc, argv, [&] { return run_all(seed, count, only, vcd_path); });
}

int CaseRunner::run_all(std::uint64_t seed, std::uint64_t count, const std::string& only,
                        const std::string& vcd_path) {
  std::optional<OutputFile> vcd;
  if (!vcd_path.empty()) vcd.emplace(vcd_path);
  std::vector<Named> cases = directed_;
  for (std::uint64_t k = 0; k < count; ++k) {
    cases.push_back({fmt::format("random {}", k), random_});
  }
  std::uint64_t run = 0, failed = 0;
  for (const Named& named : cases) {
    if (!only.empty() && named.name != only) continue;
    const bool first = run++ == 0;
    failed += run_one(named, seed, first && vcd ? &*vcd : nullptr) ? 0 : 1;
  }
  if (run == 0)
    throw InputError(fmt::format("--case: got '{}', expected the name of a case", only));
  if (vcd) vcd->commit();
  fmt::print("{} {}: {} cases, {} failed; {} checks, {} failed; seed {}\n",
             failed == 0 ? "PASS" : "FAIL", program_, run, failed, checks_, failures_, seed);
  return failed == 0 ? kDone : kFailed;
}

}  // namespace sgs::tb
