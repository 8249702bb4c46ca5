// The programs as a shell runs them, in a folder of their own.
#pragma once

#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs::test {

struct ShellOutcome {
  int status = 0;
  std::string out, err;
};

// Shell line that writes a.ply: Gaussians at these positions ("x y z"), of this opacity's logit.
std::string ply_of(const std::vector<std::string>& positions, double opacity = 1);

// Runs `line` in `scratch`: $SG and $TB are the programs, $S a small scene, $B a small job on it;
// FULL before a command lets no file grow beyond 4 KiB; AWAIT 'CONDITION' waits for it while what
// was last begun with & lives, half a minute at most, and else ends both with status 1. Longer than
// 60 s counts as never (124).
ShellOutcome shell(const ScratchFolder& scratch, const std::string& line);

// Runs it: refused with exit status 2, and these words on the error channel.
void check_refused(const ScratchFolder& scratch, const std::string& line,
                   const std::vector<std::string>& words);

}  // namespace sgs::test
