// Programs with options, and SystemC.
#pragma once

#include <functional>

#include "testbench/command_line/guard.h"

namespace CLI {
class App;
}

namespace sgs {

// run_guarded() under the name of `app` (which may not be empty): parses the command line into it,
// --version among the options, and returns what `body` does.
int run_program(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& body);

}  // namespace sgs
