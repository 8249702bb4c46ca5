// Arguments, processes and the summary of a testbench.
#include "testbench/units/case_runner.h"

#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <systemc>

#include "tlm/no_banner.h"
#include "tlm/time_resolution.h"

namespace sgs::tb {
namespace {

constexpr unsigned kCaseSeconds = 120;  // units that chase each other forever are a failure too

struct Result {
  std::uint64_t made = 0, failed = 0;
};

[[noreturn]] void child(const CaseRunner::Body& body, std::uint64_t seed, const std::string& name,
                        const std::string& vcd_path, int result_to) {
  ::alarm(kCaseSeconds);
  Checks checks;
  try {
    use_femtosecond_resolution();
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(std::hash<std::string>()(name))};
    Case test{checks, vcd_path, std::mt19937_64(mixed)};
    body(test);
  } catch (const sc_core::sc_report& report) {
    checks.that(false, fmt::format("{}: {}", report.get_msg_type(), report.get_msg()));
  } catch (const std::exception& error) {
    checks.that(false, error.what());
  }
  std::fflush(nullptr);
  const Result result{checks.made(), checks.failed()};
  const bool told = ::write(result_to, &result, sizeof result) == sizeof result;
  ::_exit(told ? 0 : 1);
}

}  // namespace

CaseRunner::CaseRunner(std::string program, std::string purpose)
    : program_(std::move(program)), purpose_(std::move(purpose)) {}

void CaseRunner::add_directed(const std::string& name, Body body) {
  directed_.push_back({name, std::move(body)});
}

bool CaseRunner::run_one(const Named& named, std::uint64_t seed, const std::string& vcd_path) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot start a process");
  if (process == 0) {
    ::close(ends[0]);
    child(named.body, seed, named.name, vcd_path, ends[1]);
  }
  ::close(ends[1]);
  Result result;
  const bool told = ::read(ends[0], &result, sizeof result) == sizeof result;
  ::close(ends[0]);
  int status = 0;
  ::waitpid(process, &status, 0);
  if (!told) {
    std::printf("  FAILED: the process ended with signal %d\n", WTERMSIG(status));
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
  constexpr int kBadArguments = 2;
  CLI::App app{purpose_};
  std::uint64_t seed = 1;
  std::uint32_t count = 100;
  std::string only, vcd_path;
  app.add_option("--seed", seed, "of the random cases")->capture_default_str();
  app.add_option("--cases", count, "random cases, after the directed ones")->capture_default_str();
  app.add_option("--case", only, "run only the case of this name");
  app.add_option("--vcd", vcd_path, "write the waveform of the first case that runs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadArguments;
  }
  std::vector<Named> cases = directed_;
  for (std::uint32_t k = 0; k < count; ++k) {
    cases.push_back({fmt::format("random {}", k), random_});
  }
  std::uint64_t run = 0, failed = 0;
  for (const Named& named : cases) {
    if (!only.empty() && named.name != only) continue;
    ++run;
    failed += run_one(named, seed, vcd_path) ? 0 : 1;
    vcd_path.clear();
  }
  if (run == 0) {
    std::fprintf(stderr, "%s: --case: there is no case '%s'\n", program_.c_str(), only.c_str());
    return kBadArguments;
  }
  std::printf("%s %s: %llu cases, %llu failed; %llu checks, %llu failed; seed %llu\n",
              failed == 0 ? "PASS" : "FAIL", program_.c_str(), static_cast<unsigned long long>(run),
              static_cast<unsigned long long>(failed), static_cast<unsigned long long>(checks_),
              static_cast<unsigned long long>(failures_), static_cast<unsigned long long>(seed));
  return failed == 0 ? 0 : 1;
}

}  // namespace sgs::tb
