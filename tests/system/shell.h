// The programs as a shell runs them, in a folder of their own.
#pragma once

#include <string>

#include "tests/support/scratch_folder.h"

namespace sgs::test {

struct ShellOutcome {
  int status = 0;
  std::string out, err;
};

// Runs `line` in `scratch`: $SG and $TB are the programs, $S a small scene, $B a small job on it;
// FULL before a command lets no file grow beyond 4 KiB. Longer than 60 s counts as never (124).
ShellOutcome shell(const ScratchFolder& scratch, const std::string& line);

}  // namespace sgs::test
