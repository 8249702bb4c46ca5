// The script around a line of shell.h.
#include "tests/system/shell.h"

#include <sys/wait.h>

#include <cstdlib>

namespace sgs::test {

ShellOutcome shell(const ScratchFolder& scratch, const std::string& line) {
  ScratchFolder outside;
  const std::string script =
      outside.write("script", "cd '" + scratch.path("") +
                                  "'\nSG='" SGS_BIN "/streaminggs'\nTB='" SGS_BIN
                                  "/tb_dram'\nS='builtin:object?n=300'\nB=\"$S --size 32x18\"\n"
                                  "FULL() { (trap '' XFSZ; ulimit -f 8; \"$@\"); }\n" +
                                  line + "\n");
  const std::string command = "timeout -k 1 60 bash '" + script + "' >'" + outside.path("out") +
                              "' 2>'" + outside.path("err") + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, bytes_of(outside.path("out")),
          bytes_of(outside.path("err"))};
}

}  // namespace sgs::test
