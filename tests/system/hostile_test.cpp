// Hostile scenes, cameras and configurations by seed: `hostile_test` runs the normal suite's,
// `hostile_test --seeds FIRST:COUNT` any others.
#define CATCH_CONFIG_RUNNER
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/run_tests.h"
#include "tests/system/hostile_cases.h"
#include "tests/system/hostile_checks.h"
#include "tests/system/streaminggs_run.h"

namespace {

struct Seeds {
  std::uint64_t first = 0, count = 0;
} seeds;

// Whether there are any.
bool read_seeds(const std::string& text) {
  std::istringstream fields(text);
  char between = 0;
  fields >> seeds.first >> between >> seeds.count;
  return fields && fields.eof() && between == ':' && text.find('-') == std::string::npos &&
         seeds.count > 0 && seeds.first <= std::numeric_limits<std::uint64_t>::max() - seeds.count;
}

}  // namespace

namespace sgs::test {
namespace {

void check_seeds(std::uint64_t first, std::uint64_t count) {
  HostileTotals totals;
  for (std::uint64_t seed = first; seed < first + count; ++seed) check_hostile(seed, totals);
  fmt::print("seeds {} to {}: {}\n", first, first + count - 1, to_text(totals));
}

TEST_CASE("hostile: each extreme alone") { check_seeds(0, hostile_extremes()); }

TEST_CASE("hostile: the seeds asked for") { check_seeds(seeds.first, seeds.count); }

TEST_CASE("hostile: where nothing would run, a line says so") {
  struct Row {
    Arguments arguments;
    std::string line;
  };
  const auto no_test = [](const std::string& name) {
    return "no test is named '" + name + "'; --list-tests tells which there are\n";
  };
  const auto no_seeds = [](const std::string& text) {
    return "--seeds: got '" + text + "', expected FIRST:COUNT, at least one\n";
  };
  std::vector<Row> rows = {{{"nosuch", "--seeds", "1:1"}, no_test("nosuch")},
                           {{"hostile*,nosuch*"}, no_test("nosuch*")},
                           {{"[no"}, no_test("[no")}};
  for (const char* text : {"5000:0", "x", "5:", "5:x", "5:1x", "5:-1", "5 1", "5:1:1",
                           "18446744073709551615:1", "18446744073709551616:1"}) {
    rows.push_back({{"hostile: the seeds asked for", "--seeds", text}, no_seeds(text)});
  }
  for (const Row& row : rows) {
    const Outcome outcome = run_program(SGS_HOSTILE, row.arguments);
    INFO(row.line << outcome.out);
    CHECK(outcome.status == 2);
    CHECK(outcome.err == row.line);
    CHECK(outcome.out.empty());
  }
}

}  // namespace
}  // namespace sgs::test

// libsystemc refers to sc_main even where Catch's main runs the tests.
extern "C" int sc_main(int, char*[]) { return 0; }

int main(int argc, char* argv[]) {
  setenv("STREAMINGGS_CACHE", "off", 1);  // the user's is none of theirs
  Catch::Session session;
  using Catch::clara::Opt;
  std::string text = "21:2";  // behind the extremes one by one
  session.cli(session.cli() | Opt(text, "FIRST:COUNT")["--seeds"]("seeds to run"));
  const int bad = session.applyCommandLine(argc, argv);
  if (bad != 0) return bad;
  if (!read_seeds(text)) {
    fmt::print(stderr, "--seeds: got '{}', expected FIRST:COUNT, at least one\n", text);
    return 2;
  }
  return sgs::test::run_tests(session);
}
