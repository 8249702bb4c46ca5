// Runs the tests that a command line names; for a file that has Catch's implementation.
#pragma once

#include <catch2/catch.hpp>
#include <iostream>

namespace sgs::test {

// Where one is named that there is not: a line that says so, and exit status 2. Catch's own status
// would be 0.
inline int run_tests(Catch::Session& session) {
  const Catch::Config& config = session.config();
  const auto refused = [](const std::string& name) {
    std::cerr << "no test is named '" << name << "'; --list-tests tells which there are\n";
    return 2;
  };
  for (const std::string& name : config.testSpec().getInvalidArgs()) return refused(name);
  const auto& all = Catch::getAllTestCasesSorted(config);
  for (const auto& [name, tests] : config.testSpec().matchesByFilter(all, config)) {
    if (tests.empty()) return refused(name);
  }
  return session.run();
}

}  // namespace sgs::test
