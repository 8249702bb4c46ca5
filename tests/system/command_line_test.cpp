// What a user types and what the programs make of it.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/shell.h"

namespace sgs::test {
namespace {

struct Row {
  std::string line;
  std::vector<std::string> words;  // in what is said on stdout
  std::string before = "";         // shell line that prepares
};

void check(const Row& row) {
  INFO(row.line);
  const ScratchFolder scratch;
  if (!row.before.empty()) REQUIRE(shell(scratch, row.before).status == 0);
  const ShellOutcome outcome = shell(scratch, row.line);
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  for (const std::string& word : row.words) {
    INFO(word);
    CHECK(outcome.out.find(word) != std::string::npos);
  }
}

TEST_CASE("command line: options and their values") {
  for (const Row& row : std::vector<Row>{
           {"$SG --version", {"streaminggs 0."}},
           {"$TB --version", {"tb_dram 0."}},
           {"$SG simulate --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$SG pack --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$TB --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$SG simulate --set group_px=32 $S --size 32x18 --out o && ls -R o", {"view_0"}},
           {"$SG simulate --set group_px=32 --weigh-by 0,1 --set hfus=2 $S --size 32x18 --out o "
            "&& ls o",
            {"view_0"}},
           {"$SG simulate $B --view 2,0 --out o && ls o", {"view_0\nview_2\n"}},
           {"$SG simulate $B --view all --out o && ls o", {"view_0", "view_4"}},
           {"$SG render $B --out new/folder/a.png && ls new/folder", {"a.png"}},
           {"$TB --config exact --print-config", {"\"dram\": {", "\"channels\": 4"}},
           {"$TB --config c.json --set dram.ranks=2 --print-config",
            {"\"channels\": 2", "\"ranks\": 2"},
            "$SG simulate $B --set dram.channels=2 --print-config >c.json"},
           {"$TB --config c.json --print-config",
            {"\"channels\": 2"},
            "$TB --set dram.channels=2 --print-config >c.json"}}) {
    check(row);
  }
}

TEST_CASE("command line: a scene that voxels cannot hold is described all the same") {
  // One Gaussian lies 3e6 world units away.
  const std::string line =
      "{ printf 'ply\\nformat ascii 1.0\\nelement vertex 200\\n'; for p in x y z f_dc_0 f_dc_1 "
      "f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3; do echo property float $p; "
      "done; echo end_header; for i in $(seq 199); do echo $i 0 $i 0 0 0 1 -5 -5 -5 1 0 0 0; done; "
      "echo 3000000 0 0 0 0 0 1 -5 -5 -5 1 0 0 0; } >a.ply";
  check({"$SG info a.ply",
         {"gaussians                 200", "occupied voxels           none: "},
         line});
}

TEST_CASE("command line: a DRAM trace holds what was simulated, however often and however idle") {
  for (const char* setting : {"dram.power_down_idle_cycles=0", "dram.power_down_idle_cycles=10"}) {
    check(
        {"for n in 100 300 500; do $SG simulate \"builtin:object?n=$n\" --size 32x18 --out o "
         "--dram-trace t --set " +
             std::string(setting) + " && $TB --check t || exit; done",
         {"commands, no violation"}});
  }
  check(
      {"$TB --transactions 300 --dram-trace t --set dram.power_down_idle_cycles=10 && $TB --check "
       "t",
       {"PASS", "no violation"}});
  check({"$TB --stream rnd --requests 300 --dram-trace t && $TB --check t", {"no violation"}});
  check({"$TB --replay r --dram-trace t && $TB --check t",
         {"no violation"},
         "printf '0 R\\n64 W 10\\n' >r"});
}

TEST_CASE("command line: of two runs with one trace, one is there whole") {
  check(
      {"for i in 1 2 3 4; do $TB --transactions 300 --seed $i --dram-trace t >/dev/null & done; "
       "wait; $TB --check t && ls",
       {"no violation", "\nt\n"}});
}

TEST_CASE("command line: a process that is killed leaves nothing under an output's name") {
  check(
      {"$TB --transactions 100000000 --vcd a.vcd --dram-trace t >/dev/null & sleep 0.5; kill -9 "
       "$!; "
       "wait; [ ! -e a.vcd ] && [ ! -e t ]",
       {}});
  // The simulation alone: whoever waits for it removes what it has begun.
  check(
      {"$SG simulate 'builtin:object?n=60000' --out o --vcd a.vcd --dram-trace t >/dev/null & "
       "until [ -n \"$(cat /proc/$!/task/$!/children)\" ]; do sleep 0.05; done; sleep 0.3; "
       "kill -9 $(cat /proc/$!/task/$!/children); wait $!; [ $? = 1 ] && [ -z \"$(ls)\" ]",
       {}});
}

}  // namespace
}  // namespace sgs::test
