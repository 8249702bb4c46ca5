// Hostile scenes, cameras and configurations by seed: `hostile_test` runs the normal suite's,
// `hostile_test --seeds FIRST:COUNT` any others.
#define CATCH_CONFIG_RUNNER
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdio>
#include <string>

#include "tests/system/hostile_cases.h"
#include "tests/system/hostile_checks.h"

namespace {

std::string seeds = "21:2";  // behind the extremes one by one

}  // namespace

namespace sgs::test {
namespace {

void check_seeds(std::uint64_t first, std::uint64_t count) {
  HostileTotals totals;
  for (std::uint64_t seed = first; seed < first + count; ++seed) check_hostile(seed, totals);
  fmt::print("seeds {} to {}: {}\n", first, first + count - 1, to_text(totals));
}

TEST_CASE("hostile: each extreme alone") { check_seeds(0, hostile_extremes()); }

TEST_CASE("hostile: the seeds asked for") {
  std::uint64_t first = 0, count = 0;
  REQUIRE(std::sscanf(seeds.c_str(), "%lu:%lu", &first, &count) == 2);
  check_seeds(first, count);
}

}  // namespace
}  // namespace sgs::test

// libsystemc refers to sc_main even where Catch's main runs the tests.
extern "C" int sc_main(int, char*[]) { return 0; }

int main(int argc, char* argv[]) {
  Catch::Session session;
  using Catch::clara::Opt;
  session.cli(session.cli() | Opt(seeds, "FIRST:COUNT")["--seeds"]("seeds to run"));
  const int bad = session.applyCommandLine(argc, argv);
  return bad != 0 ? bad : session.run();
}
