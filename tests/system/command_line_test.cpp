// What a user types and what the programs make of it.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/shell.h"

namespace sgs::test {
namespace {

struct OptionRow {
  std::string line;
  std::vector<std::string> words;  // in what is said on stdout
  std::string before = "";         // shell line that prepares
};

void check_said(const OptionRow& row) {
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

// Writes FACTOR.json, the report of a frame that takes so many times its cycles.
std::string with_cycles(const std::string& factor) {
  return "awk '/\"cycles\":/ && !n++ {sub(/[0-9]+/, int($2 * " + factor +
         "))} {print}' o/view_0/report.json >" + factor + ".json";
}

TEST_CASE("command line: options and their values") {
  for (const OptionRow& row : std::vector<OptionRow>{
           {"$SG --version", {"streaminggs 0."}},
           {"$TB --version", {"tb_dram 0."}},
           {"$SG simulate --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$SG pack --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$SG --help pack", {"exact_vq_packed", "paper_no_cgf"}},
           {"$TB --help", {"exact_vq_packed", "paper_no_cgf"}},
           {"$SG simulate --set group_width_px=32 --set group_height_px=32 $S --size 32x18 --out o "
            "&& ls -R o",
            {"view_0"}},
           {"$SG simulate --set group_width_px=32 --set group_height_px=32 --weigh-by 0,1 --set "
            "hfus=2 --set storage.encoding=vq --set sram.codebook_bytes=256000 --set "
            "storage.vq.iterations=1 $S --size 32x18 --out o "
            "&& ls o",
            {"view_0"}},
           {"$SG simulate $S --size 32x24 --out o | head -1",
            {"--size 32x24: view 0 has ", "the picture is stretched; 32x18 keeps its shape"}},
           {"$SG simulate $B --out o | tail -1", {"written to o\n"}},
           {"$SG simulate $B --verbose --out o >t && ! grep 'ties of depth' t", {}},
           {"$SG simulate $B --out o >t && [ $(wc -l <t) -le 15 ] && ! grep 'lanes (\\|^chosen' t "
            "&& "
            "cat t",
            {"view        px  PSNR dB     SSIM = streaming renderer        cycles     fps  DRAM MB "
             "  bus MB       mJ\n",
             "\nview 0: ", "\nview 0: energy ", "\n  DRAM region ", "\n  frame_buffer ",
             " mm2 at 32 nm; ", " with PHY and controller of lpddr3_1600\n"}},
           {"$SG simulate $B --config paper_text --out o && grep stated o/report.json",
            {" mm2 at 32 nm, 5.37 stated; ", "\"stated\": 5.37"}},
           {"$SG simulate $B --verbose --out o",
            {" binding ", "\n  mm2 by kind: vsu ", " lanes (fp32_lane); ",
             "\nchosen: ", "\n  frame_buffer "}},
           {"$SG simulate $B --view 0,1 --out o >t && [ $(wc -l <t) -le 15 ] && cat t",
            {"\nview 1: ", " values chosen by the model: --verbose lists them\n"}},
           {"$SG simulate $B --path builtin:path --frames 3 --out o >t && [ $(wc -l <t) -le 10 ] "
            "&& f=$(sed -n 's/.* worst [0-9,]* (frame \\([0-9]\\)).*/\\1/p' t) && "
            "grep \"^frame $f, the slowest: .* works [0-9]* % of the frame, \" t && "
            "cat t",
            {"\n3 frames along ", "\nPSNR: worst ", "\narea ", " mm2 at 32 nm; ",
             " with PHY and controller of lpddr3_1600\n", " values chosen by the model",
             "\nwritten to o\n"}},
           {"$SG simulate $B --path builtin:path --frames 3 --out o >t && $SG simulate $B --path "
            "builtin:path --frames 3 --set dram.channels=8 --out p >t && $SG diff o p",
            {"A  o/report.json\nB  p/report.json\n\nconfiguration: 1 of ", "\n     2 ",
             "\nmean of a view "}},
           {"$SG simulate $B --path builtin:path --frames 3 --verbose --out o", {" wall s\n   0 "}},
           {"$SG simulate $B --out o --config gscore_lossless --set clock_mhz=500 && cat "
            "o/report.json",
            {"gscore_lossless + 1 setting: machine gscore, blends in fp32, second halves "
             "raw\nview ",
             "\"axes\": \"as stored\"", "\"configuration\": \"gscore_lossless + 1 setting\""}},
           {"$SG simulate $B --set hfus=2 --set hfus=3 --out 'o p' >t && grep -h "
            "'\"configuration\"\\|\"command\"' 'o p/report.json'",
            {"\"configuration\": \"exact + 1 setting\"", " --out 'o p'\""}},
           {"$SG simulate $B --set clock_mhz=1001 --out o 2>&1 >t",
            {"streaminggs: note: clock_mhz 1001: depths of pipelines, areas and energies at 32 nm "
             "stand for 1000 MHz or less"}},
           {"$SG sweep $B --axis clock_mhz=900,1001 --out r 2>&1 >t", {"note: clock_mhz 1001: "}},
           {"! ($SG simulate $B --set clock_mhz=1000 --out o && $SG sweep $B --axis "
            "clock_mhz=900,1000 --out r) 2>&1 >t | grep note",
            {}},
           {"$SG simulate $B --out o >t && $SG simulate $B --set clock_mhz=500 --out p >t && "
            "$SG diff o p",
            {" ms A ", "\ntime ms  ", "\nclocks differ: time compares the runs, cycles do not\n"}},
           {"$SG simulate $B --view 2,0 --out o && ls o", {"view_0\nview_2\n"}},
           {"$SG simulate $B --view all --out o && ls o", {"view_0", "view_4"}},
           {"$SG simulate $B --out o >t && $SG simulate $B --set dram.channels=8 --out p >t && "
            "$SG diff o p/report.json",
            {"A  o/report.json\nB  p/report.json\n\nconfiguration: 1 of ",
             "  dram.channels  4 -> 8\n", "\ncycles   "}},
           {"$SG simulate $B --out o >t && $SG diff o/view_0 o --least 0",
            {"configuration: 0 of ", "equal"}},
           {"$SG simulate $B --out o >t && " + with_cycles("1.004") + " && " + with_cycles("1.01") +
                " && $SG diff o/view_0 1.004.json && ! $SG diff o/view_0 1.01.json | grep noise",
            {"+0.4 %   below the noise of a frame\n"}},
           {"$SG simulate $B --fit-memories --set hfus=8 --out o && cat o/report.json",
            {"\"configuration\": \"exact + 1 setting, memories fitted\""}},
           {"$SG sweep $B --axis hfus=8 --fit-memories --out r --csv t >o && cat t",
            {",fit_memories,", ",true,", ",done,"}},
           {"$SG simulate $B --path builtin:path --frames 2 --out o >t && ! grep late t", {}},
           {"$SG simulate $B --path builtin:path --frames 2 --out o >t && w=$(awk '/worst_fps/ "
            "{gsub(/[^0-9.]/, \"\"); printf \"worst %d (frame\", $0}' o/report.json) && tr -d , <t "
            "| "
            "grep \"$w\"",
            {"frames a second worst "}},
           {"$SG simulate $B --path builtin:path --frames 1 --out o", {"\n1 frame along "}},
           {"$SG simulate $B --path builtin:path --frames 2 --frame-rate 1e6 --out o",
            {"\n2 of 2 frames take longer than 1/1e+06 s: the next one begins late\n"}},
           {"$SG simulate $B --path builtin:path --frames 8 --stream --frame-rate 1e6 --out o",
            {"\n8 of 8 frames miss their picture (0, 1, 2, 3, 4, 5 and 2 more), "}},
           {"$SG simulate $S --size 97x61 --path builtin:path --frames 8 --stream --frame-rate 9e4 "
            "--out o",
            {" of these frames wait for a buffer that the display still shows, up to "}},
           {"$SG render $B --out new/folder/a.png && ls new/folder",
            {"written to new/folder/a.png\na.png"}},
           {"$SG render --help", {"if not given, the one of the ordering's name"}},
           {"$SG simulate --help", {"--stalls FLOAT:in [0, 1]", "probability, as 0.1,"}},
           {"$SG pack --help | grep SCENE", {"builtin:NAME?n=COUNT"}},
           {"$SG simulate --help", {"--technology TEXT=technology_32nm.json\n"}},
           {"for c in simulate what-if sweep diff pack train tune render compare photographs gpu "
            "info "
            "describe; do $SG $c --help >t && grep -q '^Exit status: 0 done.*; 2 bad arg' t && "
            "[ $(grep -o paper_no_cgf t | wc -l) -le 1 ] && ! grep /share/ t || exit 1; "
            "e=$(grep -A 1 '^Example:' t | sed -n 's/^  streaminggs //p'); echo \"$e\"; $SG $e "
            ">t 2>&1; grep 'help lists' t && exit 1; done; true",
            {"simulate scene.ply", "describe --config"}},
           {"$SG pack --help > t && ! grep -q 'made by pack' t", {}},
           {"$SG info --help", {".sgs file made by pack"}},
           {"$SG info a.ply > t && ! grep cameras t && cat t",
            {"gaussians                 1,200\n", "median opacity            0.7311\n"},
            ply_of(std::vector<std::string>(1200, "0 0 0"))},
           {"$SG info 'builtin:object?n=1200'", {"cameras                   5\n"}},
           {"$SG info d",
            {"data set                  cameras.json\n", "views                     2\n",
             "to train from             1\n", "to test with              1 (every 8th by name)\n",
             "size                      32x18 px\n", "with alpha                0\n",
             "points                    0\n",
             "cameras stand in          0 0 -5 .. 1 0 -5 (world units)\n"},
            "mkdir -p d/images; $SG render $B --out d/images/v.png; cp d/images/v.png d/w.png; c() "
            "{ "
            "echo \"{\\\"id\\\": $1, \\\"img_name\\\": \\\"$2\\\", \\\"width\\\": 64, "
            "\\\"height\\\": "
            "36, \\\"position\\\": [$1, 0, -5], \\\"rotation\\\": [[1, 0, 0], [0, 1, 0], [0, 0, "
            "1]], "
            "\\\"fx\\\": 30, \\\"fy\\\": 30}\"; }; echo \"[$(c 0 v), $(c 1 w)]\" >d/cameras.json"},
           {"$SG convert a.splat b.ply && $SG convert a.splat --out c.ply && cmp b.ply c.ply && "
            "$SG info b.ply",
            {"b.ply: 2 Gaussians of SH degree 0, ", "gaussians                 2\n"},
            "for i in 1 2; do printf '========================RGBAwxyz' >>a.splat; done"},
           {"$SG convert $S a.ply --cameras-out a.json && $SG render a.ply --cameras a.json --size "
            "32x18 --out a.png && $SG render $B --out b.png && cmp a.png b.png && $SG info a.json",
            {"a.ply: 300 Gaussians of SH degree 3, ", "cameras                   5\n"}},
           {"$SG convert a.ply b.ply 2>&1 && $SG info a.ply",
            {"streaminggs: note: a.ply: 1 element is skipped, since no picture needs it: extra\n",
             "\nnote                      1 element is skipped, since no picture needs it: "
             "extra\n"},
            ply_of({"0 0 0"}) +
                "; sed -i 's/float rot_3/&\\nelement extra 0\\nproperty float w/' a.ply"},
           {"$SG pack a.ply --config paper --out a.sgs",
            {"codebooks                 not weighted: no cameras\n", "file                      "},
            ply_of({"0 0 0"})},
           {"$SG pack a.ply --out a.sgs > t && ! grep weighted t", {}, ply_of({"0 0 0"})},
           {"$SG describe > t && ! grep -q '```' t && cat t",
            {"group_width_px = 128", "\n| unit | activity | resource | what it does |\n"}},
           {"$SG gpu $B --view 0,1 --set watts=5 --out g.json && cat g.json",
            {"modelled, not simulated: 918 MHz, 32 instructions of warps a cycle, 102.4 GB/s, of "
             "which it gets 0.125 and 0.125; single precision; joules are 5 W times modelled "
             "time\n",
             "\nmean of 2 views, modelled: ", "\"precision\": \"fp32\""}},
           {"$SG gpu $B > t && ! grep mean t", {}},
           {"$TB --config exact --print-config", {"\"dram\": {", "\"channels\": 4"}},
           {"$TB --config c.json --set dram.ranks=2 --print-config",
            {"\"channels\": 2", "\"ranks\": 2"},
            "$SG simulate $B --set dram.channels=2 --print-config >c.json"},
           {"$TB --config c.json --print-config",
            {"\"channels\": 2"},
            "$TB --set dram.channels=2 --print-config >c.json"}}) {
    check_said(row);
  }
}

TEST_CASE("command line: a scene that voxels cannot hold is described all the same") {
  std::vector<std::string> positions;
  for (int i = 1; i < 200; ++i) positions.push_back(std::to_string(i) + " 0 " + std::to_string(i));
  positions.emplace_back("3000000 0 0");
  check_said({"$SG info a.ply",
              {"gaussians                 200", "occupied voxels           none: "},
              ply_of(positions)});
}

const std::string kCameras =
    "; echo '[{\"id\": 0, \"img_name\": \"v\", \"width\": 32, \"height\": 18, \"position\": "
    "[0, 0, -5], \"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], \"fx\": 30, \"fy\": 30}]' >c";

TEST_CASE("command line: cameras that see next to nothing are doubted") {
  const std::string simulate = "$SG simulate a.ply --cameras c --out o ";
  const std::string doubt =
      "view 0: 0.00 % of the Gaussians lie in the frame: is this a camera of this scene? Expected "
      "poses from camera to world, columns right, down and forward, in the scene's coordinates; "
      "--scene-axes turns a scene\n";
  const std::string behind = ply_of({"0 0 -9"}), before = ply_of({"0 0 0"});
  for (
      const OptionRow& row : std::vector<OptionRow>{
          {simulate, {doubt}, behind},
          {simulate + ">t; sed -n '/in the frame/,$p' t | grep ' equal '", {" equal "}, behind},
          {"echo '{\"w\": 32, \"h\": 18, \"fl_x\": "
           "30, \"frames\": [{\"file_path\": \"a\", \"transform_matrix\": [[1, 0, 0, 0], "
           "[0, -1, 0, 0], [0, 0, -1, -5], [0, 0, 0, 1]]}]}' >n.json; $SG simulate a.ply --cameras "
           "n.json --out o",
           {"Expected poses from camera to world, columns right, up and backward, in"},
           behind},
          {simulate + ">t && ! grep 'in the frame' t", {}, before},
          {"sed 's/^\\[\\(.*\\)\\]$/[\\1, \\1]/' c >p; $SG simulate a.ply --path p --frames 2 "
           "--out o",
           {"\nframe 0: 0.00 % of"},
           behind},
          {"$SG sweep a.ply --cameras c --axis hfus=2 --out r 2>&1", {"a.ply " + doubt}, behind},
          {"$SG sweep a.ply --cameras c --axis hfus=2 --out r 2>&1 >t | wc -l", {"0\n"}, before}}) {
    check_said({row.line, row.words, row.before + kCameras});
  }
}

TEST_CASE("command line: a picture of nothing, and Gaussians that are dropped, are said") {
  const std::string simulate = "$SG simulate a.ply --cameras c --out o ";
  const std::string empty = "view 0: no Gaussian contributes to the picture\n";
  const std::string nothing = "no Gaussian contributes to the picture\n";
  // A camera that sees the scene, then one that is turned away from it.
  const std::string turned =
      "t=$(sed 's/^.\\(.*\\).$/\\1/; s/-5\\]/5]/' c); sed \"s/.$/, $t]/\" c >p; ";
  const std::string in_report = "&& grep '\"empty\"' o/view_0/report.json";
  for (const OptionRow& row : std::vector<OptionRow>{
           {simulate + in_report, {empty, "\"empty\": true"}, ply_of({})},
           {simulate + "--config paper", {empty}, ply_of({})},
           {simulate, {empty}, ply_of({"0 0 0"}, -9)},
           {simulate + "--config paper", {empty}, ply_of({"0 0 -9"})},
           {simulate + in_report, {"\"empty\": false"}, ply_of({"0 0 0"})},
           {simulate + "> t && ! grep contributes t", {}, ply_of({"0 0 0"})},
           {"$SG what-if a.ply --cameras c > t && [ $(wc -l <t) = 3 ] && cat t",
            {"no Gaussian contributes to the picture: there is nothing to change\n"},
            ply_of({"0 0 -9"})},
           {"$SG what-if a.ply --cameras c > t && $SG simulate a.ply --cameras c --out o > s && "
            "grep \"^nothing .* $(awk '/ yes / {print $NF}' s) mJ \" t && cat t",
            {"nothing ", "doubled "},
            ply_of({"0 0 0"})},
           {"$SG what-if a.ply --cameras c --set clock_mhz=1001 2>&1 >t",
            {"streaminggs: note: clock_mhz 1001: "},
            ply_of({"0 0 -9"})},
           {"script -qec \"$SG what-if a.ply --cameras c\" /dev/null </dev/null",
            {"\rview 0: 0 of ", " keys tried, now "},
            ply_of({"0 0 0"})},
           {"sed 's/^\\[\\(.*\\)\\]$/[\\1, \\1]/' c >p; $SG simulate a.ply --cameras p --view all "
            "--out o",
            {"\n2 of 2 views hold no Gaussian\n"},
            ply_of({"0 0 -9"})},
           {turned + "$SG simulate a.ply --path p --out o --frames 2 && cut -d, -f15 o/path.csv",
            {"\n1 of 2 frames hold no Gaussian\n", "empty\nfalse\ntrue\n"},
            ply_of({"0 0 0"})},
           {turned + "$SG simulate a.ply --path p --out o --frames 2",
            {"\n2 of 2 frames hold no Gaussian\nevery frame equals its reference picture\n"},
            ply_of({"0 0 0"}, -9)},
           {"$SG sweep a.ply --cameras c --axis hfus=2,3 --out r",
            {"\n2 of 2 frames hold no Gaussian\n"},
            ply_of({"0 0 -9"})},
           {"$SG render a.ply --cameras c --out a.png", {nothing}, ply_of({"0 0 -9"})},
           {"$SG render a.ply --cameras c --out a.png --ordering exact",
            {"\n" + nothing},
            ply_of({"0 0 -9"})},
           {"$SG gpu a.ply --cameras c", {empty}, ply_of({"0 0 -9"})},
           {"for c in 'sweep --axis hfus=2 --out r' 'render --out a.png' gpu; do $SG ${c%% *} "
            "a.ply "
            "--cameras c ${c#${c%% *}}; done >t && ! grep 'no Gaussian' t",
            {},
            ply_of({"0 0 0"})},
           {simulate + "--drop-invalid",
            {"dropped invalid: 2 Gaussians, 1 are left\n"},
            ply_of({"nan 0 0", "0 0 0", "0 inf 0"})},
           {turned + "$SG simulate a.ply --path p --frames 2 --drop-invalid --out o",
            {"dropped invalid: 1 Gaussians, 1 are left\n"},
            ply_of({"nan 0 0", "0 0 0"})},
           {simulate + "--scene-axes rub 2>&1 && cat o/view_0/report.json",
            {"\"axes\": \"rub\"", "note: a.ply: turned from axes rub to right, down, forward\n"},
            ply_of({"0 0 0"})},
           {simulate + "--drop-invalid",
            {"dropped invalid: 0 Gaussians, 1 are left\n"},
            ply_of({"0 0 0"})}}) {
    check_said({row.line, row.words, row.before + kCameras});
  }
}

TEST_CASE("command line: a folder of results holds those of one run, and what is not ours") {
  const std::string all = "$SG simulate $B --view all --out o >/dev/null";
  for (const OptionRow& row : std::vector<OptionRow>{
           {"$SG simulate $B --view 3 --out o >/dev/null && find o | sort | tr '\\n' ' '; echo end",
            {"o o/report.json o/view_3 o/view_3/error.png o/view_3/frame.exr o/view_3/frame.png "
             "o/view_3/groups.csv o/view_3/reference.exr o/view_3/reference.png "
             "o/view_3/report.json end\n"},
            all},
           {"$SG simulate $B --view 3 --out o >/dev/null && ls -d o/* | tr '\\n' ' ' && ls "
            "o/view_1 "
            "o/view_02",
            {"o/report.json o/view_02 o/view_1 o/view_3 o/view_4 ", "o/view_02:\nframe.png\n",
             "o/view_1:\nnotes\n"},
            all + "; touch o/view_1/notes; mkdir o/view_02; touch o/view_02/frame.png; mkdir real; "
                  "mv o/view_4/* real; rmdir o/view_4; ln -s ../real o/view_4"},
           {"FULL $SG simulate $B --view 3 --out o; [ $? = 1 ] && ls o", {"view_4\n"}, all},
           {"$SG simulate $B >/dev/null && $SG simulate $B --config paper_no_vq >/dev/null && "
            "$SG simulate $B --config ./my.json >/dev/null && ls -d out/*/*",
            {"out/object/exact\nout/object/my\nout/object/paper_no_vq\n"},
            "echo '{}' >my.json"}}) {
    check_said(row);
  }
}

TEST_CASE("command line: a rendered order is the picture that the preset of its name gives") {
  struct Pair {
    std::string simulate, render;
  };
  for (const Pair& pair : {Pair{"exact", "exact"}, Pair{"paper", "paper"},
                           Pair{"exact_half", "exact --config exact_half"},
                           Pair{"paper_no_vq --set storage.voxel_size=1",
                                "paper --config paper_no_vq --set storage.voxel_size=1"}}) {
    check_said({"$SG simulate $B --set framebuffer=rgb32f --out o --config " + pair.simulate +
                    " && $SG render $B --out a.exr --ordering " + pair.render +
                    " && $SG compare --exact o/view_0/frame.exr a.exr",
                {"psnr_db inf"}});
  }
}

TEST_CASE("command line: a DRAM trace holds what was simulated, however often and however idle") {
  for (const char* setting : {"dram.power_down_idle_cycles=0", "dram.power_down_idle_cycles=10"}) {
    check_said(
        {"for n in 100 300 500; do $SG simulate \"builtin:object?n=$n\" --size 32x18 --out o "
         "--dram-trace t --set " +
             std::string(setting) + " && $TB --check t || exit; done",
         {"commands, no violation"}});
  }
  check_said(
      {"$TB --transactions 300 --dram-trace t --set dram.power_down_idle_cycles=10 && $TB --check "
       "t",
       {"PASS", "no violation"}});
  check_said({"$TB --stream rnd --requests 300 --dram-trace t && $TB --check t", {"no violation"}});
  check_said({"$TB --replay r --dram-trace t && $TB --check t",
              {"no violation"},
              "printf '0 R\\n64 W 10\\n' >r"});
}

TEST_CASE("command line: of two runs with one trace, one is there whole") {
  check_said(
      {"for i in 1 2 3 4; do $TB --transactions 300 --seed $i --dram-trace t >/dev/null & done; "
       "wait; $TB --check t && ls",
       {"no violation", "\nt\n"}});
}

TEST_CASE("command line: a process that is interrupted leaves nothing at all") {
  for (const auto& [signal, status] : {std::pair{"INT", "130"}, {"TERM", "143"}}) {
    check_said(
        {"set -m; $SG simulate 'builtin:object?n=60000' --vcd a.vcd --dram-trace t >/dev/null & "
         "AWAIT '[ $(ls | grep -c part) = 2 ]'; kill -" +
             std::string(signal) + " $!; wait $!; [ $? = " + status + " ] && [ -z \"$(ls)\" ]",
         {}});
  }
}

TEST_CASE("command line: a process that is killed leaves nothing under an output's name") {
  check_said(
      {"$TB --transactions 100000000 --vcd a.vcd --dram-trace t >/dev/null & sleep 0.5; kill -9 "
       "$!; "
       "wait; [ ! -e a.vcd ] && [ ! -e t ]",
       {}});
  // The simulation alone: whoever waits for it removes what it has begun.
  check_said(
      {"$SG simulate 'builtin:object?n=60000' --out o --vcd a.vcd --dram-trace t >/dev/null & "
       "AWAIT '[ -n \"$(cat /proc/$!/task/$!/children)\" ]'; sleep 0.3; "
       "kill -9 $(cat /proc/$!/task/$!/children); wait $!; [ $? = 1 ] && [ -z \"$(ls)\" ]",
       {}});
}

}  // namespace
}  // namespace sgs::test
