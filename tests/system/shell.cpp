// The script around a line of shell.h.
#include "tests/system/shell.h"

#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>

namespace sgs::test {

std::string ply_of(const std::vector<std::string>& positions, double opacity) {
  std::string line = "{ printf 'ply\\nformat ascii 1.0\\nelement vertex " +
                     std::to_string(positions.size()) +
                     "\\n'; for p in x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 "
                     "rot_0 rot_1 rot_2 rot_3; do echo property float $p; done; echo end_header; ";
  for (const std::string& at : positions) {
    line += "echo " + at + " 0 0 0 " + std::to_string(opacity) + " -5 -5 -5 1 0 0 0; ";
  }
  return line + "} >a.ply";
}

ShellOutcome shell(const ScratchFolder& scratch, const std::string& line) {
  ScratchFolder outside;
  const std::string script =
      outside.write("script", "cd '" + scratch.path("") +
                                  "'\nSG='" SGS_BIN "/streaminggs'\nTB='" SGS_BIN
                                  "/tb_dram'\nS='builtin:object?n=300'\nB=\"$S --size 32x18\"\n"
                                  "FULL() { (ulimit -f 8; \"$@\"); }\n"
                                  "AWAIT() { for n in $(seq 600); do kill -0 $!; lives=$?; "
                                  "eval \"$1\" && return; [ $lives = 0 ] || break; sleep 0.05; "
                                  "done; echo \"in vain: $1\" >&2; kill -9 $!; exit 1; }\n" +
                                  line + "\n");
  const std::string command = "timeout -k 1 60 bash '" + script + "' >'" + outside.path("out") +
                              "' 2>'" + outside.path("err") + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, bytes_of(outside.path("out")),
          bytes_of(outside.path("err"))};
}

void check_refused(const ScratchFolder& scratch, const std::string& line,
                   const std::vector<std::string>& words) {
  const ShellOutcome outcome = shell(scratch, line);
  INFO(line << '\n' << outcome.out << outcome.err);
  CHECK(outcome.status == 2);
  for (const std::string& word : words) {
    INFO(word);
    CHECK(outcome.err.find(word) != std::string::npos);
  }
}

}  // namespace sgs::test
