// Bad input, as a shell hands it over.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/error_line.h"
#include "tests/system/shell.h"

namespace sgs::test {
namespace {

TEST_CASE("bad input: cameras that cannot be drawn are named with their file, before any heading") {
  struct Row {
    const char *width, *fx, *y;
    const char* words;  // behind the file's name
  };
  const Row rows[] = {
      {"16", "15", "1e30",
       ": camera 1: position: got (0, 1e+30, -5), expected finite numbers of at most 1e+18"},
      {"16", "1e12", "0",
       ": camera 1: focal length: got 1000000000000, expected px above 0, at most 1000000000"},
      {"65537", "15", "0", ": view 1: got 65537x9 px, expected at most 65536 a side, or --size"},
      {"200000", "15", "0", ": view 1: got 200000x9 px, expected at most 65536 a side, or --size"}};
  const auto camera = [](const Row& row) {
    return std::string(R"({"id": 7, "img_name": "v", "height": 9, "fy": 15, )") +
           R"("rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "width": )" + row.width +
           ", \"fx\": " + row.fx + ", \"position\": [0, " + row.y + ", -5]}";
  };
  for (const Row& row : rows) {
    const ScratchFolder scratch;
    scratch.write("c.json", "[" + camera({"16", "15", "0", ""}) + ", " + camera(row) + "]");
    REQUIRE(shell(scratch, "$SG pack $S --out s.sgs").status == 0);
    for (const char* command :
         {"simulate $S --view 1 --out o --cameras c.json",
          "simulate $S --config paper --view 0,1 --out o --cameras c.json",
          "simulate $S --path c.json --out o", "simulate s.sgs --view 1 --out o --cameras c.json",
          "render $S --view 1 --out o.png --cameras c.json", "gpu $S --view 1 --cameras c.json",
          "sweep $S --view 1 --axis hfus=2 --out o.jsonl --cameras c.json",
          "tune $S --boundary --out o.ply --cameras c.json"}) {
      INFO(command);
      const ShellOutcome outcome = shell(scratch, std::string("$SG ") + command);
      CHECK(outcome.status == 2);
      CHECK(outcome.err == std::string("streaminggs: c.json") + row.words + "\n");
      CHECK(outcome.out.empty());
    }
  }
}

TEST_CASE("bad input: a technology with a misspelt row is refused before any heading") {
  const ScratchFolder scratch;
  const ShellOutcome outcome =
      shell(scratch, "sed 's/\"adder\":/\"addder\":/' " SGS_TECHNOLOGY
                     " >t.json; $SG simulate $B --out o --technology t.json");
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("t.json: parts.addder: no kind of part; did you mean adder?") !=
        std::string::npos);
  CHECK(outcome.out.empty());
}

TEST_CASE("bad input: what would never end is refused at once") {
  for (const ErrorLine& row : std::vector<ErrorLine>{
           {"$SG simulate $B --out o --config pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$SG simulate $B --out o --config ./zeros", 2, {"zeros"}, "ln -s /dev/zero zeros"},
           {"$SG simulate $B --out o --cameras pipe", 2, {"pipe"}, "mkfifo pipe"},
           {"$SG simulate $B --timeline t --timeline-groups 3-2 --out o",
            2,
            {"3-2", "lower first"}},
           {"$SG simulate $B --timeline t --timeline-groups x --out o", 2, {"'x'", "as in 4-7"}},
           {"$SG simulate $B --timeline t --timeline-groups 0-1 --out o",
            2,
            {"'0-1'", "the frame has 1: expected 0 to 0"}},
           {"$SG simulate $B --config gscore --timeline t --timeline-groups 99 --out o",
            2,
            {"'99'", "the frame has "}},
           {"$SG simulate $B --timeline-groups 2 --out o", 2, {"--timeline"}},
           {"$SG simulate $B --timeline t --view all --out o", 2, {"--timeline", "one view"}},
           {"$SG simulate $B --timeline o/report.json --out o", 2, {"o/report.json"}},
           {"$SG simulate $B --path pipe --out o", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$SG simulate $B --path builtin:path --view 0 --out o", 2, {"--view", "--path"}},
           {"$SG simulate $B --path builtin:path --cameras c.json --out o",
            2,
            {"--cameras: got c.json with --path builtin:path, which says what is drawn, expected "
             "one of the two"}},
           {"$SG simulate s.sgs --config exact_vq --path p.json --cameras c.json --out o",
            2,
            {"--cameras: got c.json with --path p.json"},
            "$SG pack $S --config exact_vq --set storage.vq.iterations=1 --out s.sgs"},
           {"$SG simulate $B --path builtin:path --vcd v --out o", 2, {"--vcd", "--path"}},
           {"$SG simulate $B --path builtin:path --frames 0 --out o", 2, {"--frames"}},
           {"$SG simulate $B --frames 3 --out o", 2, {"--frames", "--path"}},
           {"$SG simulate $B --path builtin:path --frame-rate 60,90 --out o",
            2,
            {"--frame-rate: got 2 rates, expected one with --path"}},
           {"$SG simulate $B --frame-rate 60,0 --out o",
            2,
            {"--frame-rate: got 0, expected a number from 0.001 to 1000000, or 0 with --stream"}},
           {"$SG simulate $B --frame-rate 60,,90 --out o",
            2,
            {"--frame-rate: got '60,,90', whose number 2 is '', expected a number from 0.001 to "
             "1000000, or 0"}},
           {"$SG simulate $B --frame-rate 1e-9 --out o",
            2,
            {"--frame-rate: got '1e-9', whose number 1 is '1e-9', expected a number from 0.001 "
             "to "}},
           {"$SG simulate $B --rate 90 --out o",
            2,
            {"--rate 90: no such option; did you mean --frame-rate?"}},
           {"$SG simulate $B --path builtin:circle --out o",
            2,
            {"--path: got builtin:circle, expected builtin:path"}},
           {"$SG simulate $B --frame-rate 90,90 --out o",
            2,
            {"--frame-rate: got '90,90', whose number 2 is 90 again, expected different ones"}},
           {"$SG simulate $B --stream --out o", 2, {"--stream", "--path"}},
           {"$SG simulate $B --path builtin:path --stream --frames 1 --out o",
            2,
            {"--frames: got 1, expected 2 or more with --stream"}},
           {"$SG simulate $B --path builtin:path --stream --frame-rate 60,90 --out o",
            2,
            {"--frame-rate: got 2 rates, expected one with --path"}},
           {"$SG simulate $B --path builtin:path --frame-rate 0 --out o",
            2,
            {"--frame-rate: got 0, expected a number from 0.001 to 1000000, or 0 with --stream"}},
           {"$SG simulate $B --path builtin:path --stream --frame-rate 0.001 --out o",
            2,
            {"--frame-rate: got 0.001: 60 frames take 60000 s, expected less than 10000 s"}},
           {"$SG simulate $B --weigh-by 0,,2 --out o",
            2,
            {"--weigh-by: got '0,,2', whose number 2 is '', expected a whole number from 0 to "}},
           {"$SG simulate $S --size 32x18 --path o/report.json --out o",
            2,
            {"o/report.json", "is the same file as the input"},
            "mkdir o; c='{\"id\":0,"
            "\"img_name\":\"\",\"width\":9,\"height\":9,\"fx\":9,\"fy\":9,"
            "\"position\":[0,0,-5],\"rotation\":[[1,0,0],[0,1,0],[0,0,1]]}'; "
            "echo \"[$c,$c]\" >o/report.json"},
           {"$SG diff pipe pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$SG diff a a", 2, {"a/report.json"}, "mkdir a"},
           {"$SG diff a.json a.json", 2, {"a.json"}, "printf '{' >a.json"},
           {"$SG diff a.json a.json", 2, {"a.json: schema_version"}, "printf '{}' >a.json"},
           {"$SG diff a.json", 2, {"B"}, "printf '{}' >a.json"},
           {"$SG diff a.json a.json --least -1", 2, {"--least"}, "printf '{}' >a.json"},
           {"$SG info pipe.ply", 2, {"pipe.ply"}, "mkfifo pipe.ply"},
           {"$SG info pipe.sgs", 2, {"pipe.sgs"}, "mkfifo pipe.sgs"},
           {"$SG compare a.exr a.exr", 2, {"a.exr", "regular"}, "mkfifo a.exr"},
           {"$SG compare a.png a.png", 2, {"a.png", "regular"}, "mkfifo a.png"},
           {"$SG compare a.pfm a.pfm", 2, {"a.pfm", "regular"}, "mkfifo a.pfm"},
           {"$SG compare a.pfm a.pfm",
            2,
            {"a.pfm: pixel (1, 0): got (nan, "},
            "printf 'Pf\\n2 1\\n-1\\n\\0\\0\\0\\0\\0\\0\\300\\177' >a.pfm"},
           {"$TB --replay pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$TB --replay .", 2, {"regular"}},
           {"$TB --replay /dev/zero", 2, {"/dev/zero", "regular"}},
           {"$TB --check pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$TB --check .", 2, {"regular"}},
           {"$TB --config pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$TB --table --published pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$TB --set dram.memspec=pipe", 2, {"pipe", "regular"}, "mkfifo pipe"},
           {"$TB --transactions -1", 2, {"--transactions", "-1"}},
           {"$TB --requests -1 --stream rnd", 2, {"--requests", "-1"}},
           {"$TB --set dram.memspec=m.json",
            2,
            {"m.json: timing_cycles.refi: got 110", "104"},
            "sed 's/\"refi\": 3120/\"refi\": 110/' " SGS_MEMSPEC " >m.json"}}) {
    check(row);
  }
}

TEST_CASE("bad input: depth") {
  for (const char* path : {"--config d.json", "--cameras d.json"}) {
    check({"$SG simulate $B --out o " + std::string(path),
           2,
           {"d.json", "64 deep"},
           "head -c 80000 /dev/zero | tr '\\0' '[' >d.json"});
  }
  check({"$SG simulate $B --out o --config d.json",
         2,
         {"d.json", "64 deep"},
         "for i in $(seq 17000); do printf '{\"a\":'; done >d.json"});
  check({"$SG simulate $B --out o --set $(head -c 34000 /dev/zero | sed 's/\\x0\\x0/a./g')a=1",
         2,
         {"--set a.a.a", "more than 64"}});
  check({"$SG simulate $B --out o --set hfus=$(head -c 80000 /dev/zero | tr '\\0' '[')",
         2,
         {"--set hfus=[[["}});
  check({"$TB --set dram.memspec=d.json",
         2,
         {"d.json", "64 deep"},
         "head -c 80000 /dev/zero | tr '\\0' '[' >d.json"});
}

TEST_CASE("bad input: numbers, keys and values that mean nothing") {
  for (const ErrorLine& row : std::vector<ErrorLine>{
           {"$SG simulate $B --out o --seed -1", 2, {"--seed", "'-1'"}},
           {"$SG simulate $B --out o --seed 100000000000000000000000", 2, {"--seed"}},
           {"$SG simulate $B --out o --stalls nan", 2, {"--stalls", "nan"}},
           {"$SG simulate $B --out o --process-order -1", 2, {"--process-order"}},
           {"$SG simulate $B --out ''", 2, {"--out", "got nothing"}},
           {"$SG simulate $B --out o --vcd ''", 2, {"--vcd", "got nothing"}},
           {"$TB --seed -1", 2, {"--seed", "'-1'", "9223372036854775807"}},
           {"$TB --seed 100000000000000000000000", 2, {"--seed", "100000000000000000000000"}},
           {"$TB --seed 0x5", 2, {"--seed", "0x5"}},
           {"$SG render $B --out a.png --voxel-size nan", 2, {"--voxel-size", "nan"}},
           {"$SG render $B --out a.png --voxel-size -1", 2, {"--voxel-size", "-1"}},
           {"$SG render $B --out a.png --group 4.5", 2, {"--group", "4.5"}},
           {"$SG render $B --out a.png --set nosuch=1", 2, {"--set", "reference", "--ordering"}},
           {"$SG render $B --out a.png --config exact", 2, {"--config", "--ordering"}},
           {"$SG render $B --out a.png --ordering exact --set nosuch=1", 2, {"nosuch: unknown"}},
           {"$SG render $B --out a.png --ordering paper --config exact_half",
            2,
            {"--ordering paper", "of machine exact", "expected one of machine paper"}},
           {"$SG info nofile.ply", 2, {"nofile.ply: no such file", ".ply", ".sgs", "data set"}},
           {"$SG info d", 2, {"d: holds no data set", "transforms.json", "sparse/0"}, "mkdir d"},
           {"$SG info d",
            2,
            {"d: holds transforms.json and cameras.json, expected one"},
            "mkdir d; touch d/cameras.json d/transforms.json"},
           {"$SG info d",
            2,
            {"d/cameras.json: line 1, column 1: not JSON: unexpected end of input"},
            "mkdir d; touch d/cameras.json"},
           {"$SG info d --drop-invalid", 2, {"--drop-invalid: d is a folder"}, "mkdir d"},
           {"$SG info d",
            2,
            {"d/images/v.png: not a regular file"},
            "mkdir -p d/images; mkfifo d/images/v.png; echo '[{\"id\": 0, \"img_name\": \"v\", "
            "\"width\": 32, \"height\": 18, \"position\": [0, 0, -5], \"rotation\": [[1, 0, 0], "
            "[0, 1, 0], [0, 0, 1]], \"fx\": 30, \"fy\": 30}]' >d/cameras.json"},
           {"$SG convert $S a.txt", 2, {"a.txt, expected a name that ends in .ply"}},
           {"$SG convert a.splat a.ply --cameras-out a.json",
            2,
            {"--cameras-out: got it with a.splat, which brings no cameras"},
            "printf '%032d' 0 >a.splat"},
           {"$SG convert a.ply a.ply",
            2,
            {"a.ply: is the same file as the input a.ply"},
            "touch a.ply"},
           {"$SG info a.splat --level 1",
            2,
            {"a.splat: got level 1 of a splat file, which has no levels"},
            "printf '%032d' 0 >a.splat"},
           {"$SG info d --level 1", 2, {"--level: d is a folder of photographs"}, "mkdir d"},
           {"$SG info a.splat --scene-axes ruf",
            2,
            {"a.splat: got the axes ruf, expected", "does not mirror, as rub"},
            "printf '%032d' 0 >a.splat"},
           {"$SG info $S --scene-axes rub", 2, {"got the axes rub, expected none: it is made"}},
           {"$SG pack $S --out a.txt", 2, {"--out: a.txt, expected", "ends in .sgs or .ply"}},
           {"$SG pack nofile.ply --out a.sgs", 2, {"a SOG folder) or builtin:NAME?n=COUNT\n"}},
           {"$SG simulate a.ply --drop-invalid --cameras c --out o",
            2,
            {"a.ply: --drop-invalid leaves none of 2 Gaussians"},
            ply_of({"nan 0 0", "0 inf 0"})},
           {"$SG render $B --out a.gif", 2, {"a.gif", ".exr, .pfm or .png"}},
           {"$SG render $B --out a.png --view 0,2", 2, {"--view", "2 views"}},
           {"$SG simulate $B --out o --view 0,0", 2, {"--view", "each once"}},
           {"$SG simulate $B --out o --view 0,", 2, {"--view", "''"}},
           {"$SG simulate $B --out o --view 0,9", 2, {"--view", "'9'"}},
           {"$SG simulate $B --out o --config foo", 2, {"--config foo", "exact_vq", "paper"}},
           {"$SG simulate $B --out o --set", 2, {"--set"}},
           {"$SG simulate $B --out o --cameras c.json",
            2,
            {"c.json: key 'id' twice"},
            "echo '[{\"id\": 1, \"id\": 2}]' >c.json"},
           {"$SG simulate $B --out o --cameras c.json",
            2,
            {"c.json: holds no cameras"},
            "echo '[]' >c.json"},
           {"$SG pack $S --out a.sgs --cameras c.json",
            2,
            {"c.json: holds no cameras"},
            "echo '[]' >c.json"},
           {"$SG simulate $B --out o --config ''", 2, {"--config", "got nothing"}},
           {"$SG simulate d --cameras c --out o",
            2,
            {"d: got a folder, expected a scene (.ply"},
            "mkdir d"},
           {"$SG simulate $S --out o --size 3", 2, {"--size: got '3', expected WIDTHxHEIGHT"}},
           {"$SG simulate $B --out o --seed 3", 2, {"--seed requires --stalls"}},
           {"$SG simulate $B --out o --weigh-by 0", 2, {"--weigh-by: got it with", "raw"}},
           {"$SG simulate $B --out o --set storage.vq.sh_entries=9",
            2,
            {"--set storage.vq.sh_entries=9: got it with storage.encoding raw"}},
           {"$SG simulate $B --out o --set codebook.preloaded=true",
            2,
            {"--set codebook.preloaded=true: got it with storage.encoding raw, which has no "
             "codebooks, expected vq or vq_packed"}},
           {"$SG simulate $B --out o --set group_width_px=30",
            2,
            {"--set group_width_px=30: group_width_px: got 30, expected a multiple of 4"}},
           {"$SG simulate $B --out o --config c.json",
            2,
            {"c.json: hfu.cfu_macs: got 1 with hfu.cost counted"},
            "echo '{\"hfu\": {\"cfu_macs\": 1}}' >c.json"},
           {"$SG compare a.png b.png",
            2,
            {"b.png: got 32x18 px, expected the 32x20 of a.png"},
            "$SG render $S --size 32x20 --out a.png; $SG render $S --size 32x18 --out b.png"},
           {"$SG simulate $B --out o --technology t.json",
            2,
            {"t.json: name: got none"},
            "echo '{}' >t.json"},
           {"$SG sweep $B --axis hfus=2", 2, {"--out"}},
           {"$SG sweep $B --out r", 2, {"--axis, --points: got both or neither"}},
           {"$SG sweep $B --out r --axis hfus=2 --points p",
            2,
            {"--axis, --points: got both or neither"},
            "echo hfus=2 >p"},
           {"$SG sweep $B --out r --axis hfus", 2, {"--axis: got 'hfus', expected KEY=VALUE,"}},
           {"$SG sweep $B --out r --axis hfus=2,", 2, {"--axis: got 'hfus=2,', expected KEY="}},
           {"$SG sweep $B --out r --axis hfus=2,2", 2, {"expected different values"}},
           {"$SG sweep $B --out r --axis hfus=2 --axis hfus=4", 2, {"--axis: got hfus twice"}},
           {"$SG sweep $B --out r --points nofile", 2, {"nofile"}},
           {"$SG sweep $B --out r --points p", 2, {"p: holds no points"}, "echo '# none' >p"},
           {"$SG sweep $B --out r --points p",
            2,
            {"p:2: got 'hfus', expected"},
            "printf '\nhfus' >p"},
           {"$SG sweep $B --out r --points p",
            2,
            {"p:1: seed: unknown key, expected one of id, scene"},
            "echo '{\"seed\": 1}' >p"},
           {"$SG sweep $B --out r --points p",
            2,
            {"p:1: line 1, column 7: not JSON: "},
            "echo '{\"set\"' >p"},
           {"$SG sweep --out r --axis hfus=2", 2, {"SCENE: got none, expected a scene (.ply"}},
           {"$SG sweep nofile.ply --out r --axis hfus=2", 2, {"nofile.ply: no such file"}},
           {"$SG sweep $B --out r --axis hfus=2 --view 9", 2, {"--view", "'9'"}},
           {"$SG sweep $S --out r --axis hfus=2 --size 3", 2, {"--size: got '3'"}},
           {"$SG sweep $B --out r --axis hfus=2 --stereo 1",
            2,
            {"--stereo: got '1', expected ipd="}},
           {"$SG what-if $B --stereo ipd=1 --config paper",
            2,
            {"--stereo: got it with machine paper"}},
           {"$SG sweep $B --out r --axis hfus=2 -j 0", 2, {"-j", "'0'"}},
           {"$SG sweep $B $S --out r --axis hfus=2 --cameras a --cameras b --cameras c",
            2,
            {"--cameras: got 3 files for 2 scenes"}},
           {"$SG sweep $B --out r --axis hfus=2 --config foo", 2, {"--config foo", "exact_vq"}},
           {"$SG sweep $B --out d --axis hfus=2", 2, {"d"}, "mkdir d"},
           {"$SG sweep $B --out p --axis hfus=2", 2, {"p"}, "mkfifo p"},
           {"$SG sweep $B --out r --csv r --axis hfus=2", 2, {"r"}},
           {"$SG sweep $B --out p --points p", 2, {"p"}, "echo hfus=2 >p"},
           {"$TB --table --set dram.channels=2", 2, {"--config, --set: got them with --table"}},
           {"$TB --check t --config exact", 2, {"--config, --set: got them with --check"}},
           {"$SG simulate $B --out o --cameras ''", 2, {"--cameras", "got nothing"}},
           {"$SG simulate $B --out o --cache ''", 2, {"--cache", "got nothing"}},
           {"$TB --config ''", 2, {"--config", "got nothing"}},
           {"$TB --vcd ''", 2, {"--vcd", "got nothing"}},
           {"$TB --dram-trace ''", 2, {"--dram-trace", "got nothing"}},
           {"$TB --replay ''", 2, {"--replay", "got nothing"}},
           {"$TB --check ''", 2, {"--check", "got nothing"}},
           {"$TB --replay r", 2, {"r: got no request"}, "echo '# nothing' >r"},
           {"$TB --replay r",
            2,
            {"r: request 2: got 64 bytes from 2147483600, expected them below", "2147483648"},
            "printf '0 R\\n2147483600 W 0 64\\n' >r"},
           {"$TB --set channels=2", 2, {"--set channels=2", "dram.KEY=VALUE"}},
           {"$TB --config c.json",
            2,
            {"c.json: channels: got it outside of dram"},
            "echo '{\"channels\": 2}' >c.json"},
           {"$TB --config c.json",
            2,
            {"c.json: dram.chanels: unknown key"},
            "echo '{\"dram\": {\"chanels\": 2}}' >c.json"}}) {
    check(row);
  }
}

TEST_CASE("bad input: messages are short, clean and begin with the program") {
  check({"$SG",
         2,
         {"got no command",
          "simulate, what-if, sweep, diff, pack, train, tune, render, compare, photographs, gpu, "
          "convert, info, "
          "describe"}});
  check({"$SG simulat $S",
         2,
         {"'simulat': no such command",
          "simulate, what-if, sweep, diff, pack, train, tune, render"}});
  check({"$SG '' --help", 2, {"'': no such command"}});
  check({"$SG simulate", 2, {"SCENE"}});
  for (const auto& [line, said] : std::vector<std::pair<std::string, std::string>>{
           {"$SG simulate $B --hfus 8", "--hfus 8: no such option; did you mean --set hfus=8?"},
           {"$SG simulate --hfus 8 $B", "--hfus 8: no such option; did you mean --set hfus=8?"},
           {"$SG simulate --input-bytes=4096 $B", "did you mean --set sram.input_bytes=4096?"},
           {"$SG simulate $B --hfus", "did you mean --set hfus=VALUE?"},
           {"$SG simulate $B --confg exact",
            "--confg exact: no such option; did you mean --config?"},
           {"$SG gpu $B --wats 5", "--wats 5: no such option; did you mean --set watts=5?"},
           {"$SG simulate --scene $S",
            "--scene builtin:object?n=300: no such option; did you mean builtin:object?n=300 "
            "alone? "
            "SCENE takes no name before it"},
           {"$SG simulate --scene=a.ply --size 32x18", "did you mean a.ply alone? SCENE takes no"},
           {"$SG train --dataset", "did you mean DATASET alone? DATASET takes no name before it"},
           {"$SG simulate --hfus=8", "--hfus 8: no such option; did you mean --set hfus=8?"},
           {"$SG compare a b --hfus 8", "--hfus 8: no such option (streaminggs compare --help"},
           {"$SG simulate $B 8", "got '8', expected no further argument"},
           {"$SG simulat $B", "; did you mean simulate? Expected one of simulate, what-if"},
           {"$SG simulate $B --config exat", "; did you mean exact? Expected one of exact, "},
           {"$SG simulate $B --set hfuss=8", "unknown key; did you mean hfus? Expected one of "},
           {"$SG simulate $B --config gscore --set sram.shared_bytes=0",
            "sram.shared_bytes: unknown key, expected one of buffer_bytes; it is a key of machine "
            "exact and paper, not of gscore"},
           {"$SG simulate $B --config gscore --set hfu.cfus=2",
            "; it is a key of machine exact and paper, not of gscore"},
           {"$SG simulate $B --set lists.lines=2", "; it is a key of machine gscore, not of exact"},
           {"$SG simulate $B --config gscore_boxes --set storage.sequence=file",
            "; not with culling.by=chunk_boxes, but with culling.by=gaussians"},
           {"$SG simulate $B --set dram.io_pj_per_bit=-0.5", "got -0.5, expected a number in [0"},
           {"$SG describe --memspec lpddr3_1600_4gb --set hfus=8", "excludes --"},
           {"$SG describe --config paper --memspec lpddr3_1600_4gb", "excludes --"},
           {"$SG convert $S", "--out: got none, expected one file to write"},
           {"$SG what-if $B --out o", "--out: o, expected a name that ends in .json"},
           {"$SG gpu $B --out o", "--out: o, expected a name that ends in .json"},
           {"$SG convert $S a.ply --out b.ply", "--out: got it and a.ply, expected one file"},
           {"$SG simulate $B --set machine=papre", "; did you mean paper?"},
           {"$SG simulate $B --set hfu=8", "expected an object; did you mean hfus?"},
           {"$SG simulate $B --set input_byte=8", "; did you mean sram.input_bytes?"},
           {"$SG simulate builtin:objct", "; did you mean builtin:object?"}}) {
    check({line, 2, {said}});
  }
  check({"$SG simulate $B --no-such-option",
         2,
         {"--no-such-option", "(streaminggs simulate --help lists what there is)"}});
  check({"$TB --no-such-option", 2, {"--no-such-option", "(tb_dram --help lists"}});
  check({"$SG render $B --out a.png --ordering soon", 2, {"soon", "reference", "exact"}});
  check({"$SG simulate $B --out o --set group_width_px=$(head -c 100000 /dev/zero | tr '\\0' x)",
         2,
         {"group_width_px: got \"xxx", "bytes left out", "an integer"}});
  check({"$SG simulate $B --out o --config c.json",
         2,
         {"c.json: group_width_px: got \"xxx", "left out"},
         "(printf '{\"group_width_px\": \"'; head -c 1000000 /dev/zero | tr '\\0' x; echo '\"}') "
         ">c.json"});
  check({"$SG simulate $B --out o --config c.json",
         2,
         {"\\x1b[31m", "\\n"},
         "printf '{\"\\\\u001b[31m\\\\nred\": 1}' >c.json"});
  check({"$SG info \"$(printf 'a\\033[2J\\nb')\"", 2, {"a\\x1b[2J\\nb"}});
}

// AddressSanitizer reserves more than any limit leaves.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("bad input: out of memory is said in one line, and over what") {
  const std::string limit = "ulimit -v 300000; ";
  const std::string large = "'builtin:object?n=2000000'";
  for (const std::string& line :
       {"$SG render " + large + " --out a.png", "$SG simulate " + large + " --out o"}) {
    check({limit + line, 1, {"out of memory while reading builtin:object?n=2000000"}});
  }
  check({limit + "$SG info a.ply",
         1,
         {"out of memory while reading a.ply"},
         "(printf 'ply\\nformat ascii 1.0\\nelement vertex 1\\n'; for p in x y z f_dc_0 f_dc_1 "
         "f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3; do echo property float "
         "$p; done; echo end_header) >a.ply; truncate -s 320M a.ply"});
  check(
      {"ulimit -v 560000; $SG info " + large + " >/dev/null", 1, {"out of memory while running"}});
}
#endif

}  // namespace
}  // namespace sgs::test
