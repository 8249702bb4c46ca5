// Programs with options, and SystemC.
#pragma once

#include <functional>

#include "testbench/command_line/command_line.h"
#include "testbench/command_line/guard.h"

namespace sgs {

// run_guarded() under the name of `line` (which may not be empty): parses the command line into it
// and returns what `body` does.
int run_program(CommandLine& line, int argc, const char* const* argv,
                const std::function<int()>& body);

}  // namespace sgs
