#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/support/run_tests.h"

// libsystemc refers to sc_main even where Catch's main runs the tests.
extern "C" int sc_main(int, char*[]) { return 0; }

int main(int argc, char* argv[]) {
  setenv("STREAMINGGS_CACHE", "off", 1);  // the user's is none of theirs
  Catch::Session session;
  const int bad = session.applyCommandLine(argc, argv);
  return bad != 0 ? bad : sgs::test::run_tests(session);
}
