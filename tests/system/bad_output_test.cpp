// Bad places for outputs, full disks and closed streams, as a shell hands them over.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/error_line.h"
#include "tests/system/shell.h"

namespace sgs::test {
namespace {

TEST_CASE("bad output: outputs have a place before the work begins") {
  const std::string images =
      "mkdir d; mkfifo p.exr p.png p.sgs p.vcd; ln -s /dev/null n.png; "
      "touch file; echo old >a.png";
  for (const char* name : {"d/.", "p.png", "p.exr", "n.png", "file/a.png", "file/a.exr",
                           "/proc/a.exr", "/proc/a.png", "/proc/a.pfm"}) {
    check({"$SG render 'builtin:object?n=2000000' --out " + std::string(name), 2, {name}, images});
  }
  for (const char* name : {"p.sgs", "file/a.sgs", "/proc/a.sgs"}) {
    check({"$SG pack 'builtin:object?n=2000000' --out " + std::string(name), 2, {name}, images});
  }
  for (const std::string option : {" --vcd ", " --dram-trace "}) {
    for (const char* name : {"d", "p.vcd", "n.png", "file/a", "/proc/a"}) {
      check({"$TB --transactions 1000000" + option + name, 2, {name}, images});
      check({"$SG simulate $B --out o" + option + name, 2, {name}, images});
    }
  }
  for (const char* name : {"file", "/proc/o", "p.png", "n.png"}) {
    check({"$SG simulate $B --out " + std::string(name), 2, {name}, images});
  }
  check({"$SG simulate $B --out o",
         2,
         {"o/view_0/frame.exr", "a device or a pipe"},
         "mkdir -p o/view_0; mkfifo o/view_0/frame.exr"});
}

TEST_CASE("bad output: no output over an input, or over another output") {
  const std::string scene =
      "$SG pack $S --out s.sgs >/dev/null; ln -s s.sgs l.sgs; "
      "ln s.sgs h.sgs; $TB --transactions 9 --dram-trace t >/dev/null; "
      "echo '0 R' >r; ln -s r lr; cp " SGS_MEMSPEC
      " m.json; "
      "echo '{\"dram\": {}}' >c.json; echo '[{\"id\": 0, \"img_name\": \"v\", \"width\": 32, "
      "\"height\": 18, \"position\": [0, 0, -5], \"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "
      "\"fx\": 30, \"fy\": 30}]' >cameras.json; ln -s cameras.json l.json";
  for (const char* line :
       {"$SG pack l.sgs --out s.sgs", "$TB --replay r --dram-trace r",
        "$TB --replay r --dram-trace lr", "$TB --replay lr --dram-trace ./r",
        "$TB --config ./c.json --dram-trace c.json", "$TB --set dram.memspec=m.json --vcd m.json",
        "$TB --vcd a --dram-trace ./a", "$SG simulate s.sgs --cameras l.json --vcd ./s.sgs",
        "$SG simulate s.sgs --cameras l.json --dram-trace h.sgs",
        "$SG simulate $S --cameras l.json --out o --vcd l.json",
        "$SG simulate $B --config ./c.json --out o --dram-trace c.json",
        "$SG simulate $B --set dram.memspec=m.json --out o --vcd m.json",
        "$SG simulate $B --out o --vcd a --dram-trace a",
        "$SG simulate $B --out o --vcd o/view_0/report.json", "$SG simulate $B --vcd y --out y",
        "$SG simulate $B --out o --dram-trace o/view_0"}) {
    check({line, 2, {}, scene});
  }
}

TEST_CASE("bad output: a full disk leaves no file, and exit status 1") {
  for (const ErrorLine& row : std::vector<ErrorLine>{
           {"FULL $SG simulate $B --out o", 1, {"o/view_0/", "cannot be written"}},
           {"FULL $SG simulate $B --out o", 1, {"o/view_0/"}, "$SG simulate $B --out o"},
           {"FULL $TB --transactions 200 --vcd a.vcd >/dev/null", 1, {"a.vcd"}, "echo old >a.vcd"},
           {"FULL $TB --transactions 200 --dram-trace a", 1, {"a: cannot be written completely"}},
           {"FULL $TB --stream rnd --requests 2000 --dram-trace a", 1, {"a: cannot be written"}},
           {"FULL $SG render $S --size 320x180 --out a.exr", 1, {"a.exr: cannot be written"}},
           {"FULL $SG render $S --size 320x180 --out a.pfm", 1, {"a.pfm: cannot be written"}},
           {"FULL $SG render $S --size 640x360 --out x/y/a.png", 1, {"a.png: cannot be written"}},
           {"FULL $SG pack $S --out a.sgs", 1, {"a.sgs: cannot be written"}}}) {
    check(row);
  }
}

TEST_CASE("bad output: standard output that is full or closed is an error") {
  for (const char* line : {"$SG --help", "$SG --version", "$SG info $S", "$TB --print-config",
                           "$TB --transactions 9", "$SG compare a.png a.png"}) {
    check({std::string(line) + " >/dev/full",
           1,
           {"standard output cannot be written"},
           "$SG render $B --out a.png"});
    check({std::string(line) + " >&-",
           1,
           {"standard output cannot be written"},
           "$SG render $B --out a.png"});
  }
  // What is opened next must not get the number of a closed stream.
  const ScratchFolder scratch;
  CHECK(shell(scratch,
              "$SG render $B --out a.png >&- 2>&- <&-; $SG render $B --out b.png; "
              "cmp a.png b.png")
            .status == 0);
}

}  // namespace
}  // namespace sgs::test
