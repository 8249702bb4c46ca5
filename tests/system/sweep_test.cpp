// sweep: what it says of a point is what simulate says, and nothing is lost or done twice whatever
// ends it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/shell.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

std::vector<Json> results_in(const ScratchFolder& scratch, const std::string& file) {
  return lines_of(bytes_of(scratch.path(file)));
}

void require_done(const ShellOutcome& outcome, int status = 0) {
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == status);
}

// Every leaf of `part` stands in `whole`, with the same value. Returns how many there are.
int check_contained(const Json& part, const Json& whole, const std::string& path) {
  INFO(path);
  if (part.is_object()) {
    int leaves = 0;
    for (const auto& [key, value] : part.items()) {
      REQUIRE(whole.contains(key));
      leaves += check_contained(value, whole.at(key), path + "." + key);
    }
    return leaves;
  }
  CHECK(part == whole);
  return 1;
}

// What differs between two runs of one simulation.
Json without_time(Json result) {
  result["report"].erase("host");
  return result;
}

TEST_CASE("sweep: a result is simulate's report of that point, to the digit") {
  const ScratchFolder scratch;
  struct Case {
    std::string config, settings;
    int view;
    std::string stereo = {};
  };
  const std::vector<Case> cases = {
      {"exact", "", 0},
      {"exact", "group_width_px=32 group_height_px=32 sram.shared_bytes=0", 1},
      {"exact", "group_width_px=0 group_height_px=0 storage.chunk_gaussians=0", 0},
      {"exact", "merge.entries=32 merge.on_overflow=blend_early", 0},
      {"exact_half", "framebuffer=rgb32f", 0},
      {"exact_vq", "", 0},
      {"exact_vq_packed", "", 1},
      {"paper", "storage.voxel_size=0", 0},
      {"paper_no_vq", "vsu.ray_step_px=4", 1},
      {"gscore", "tiles.reach=visible", 0},
      {"exact", "group_width_px=32 group_height_px=32", 0, "ipd=0.064"},
      {"exact_vq", "group_width_px=32 group_height_px=32", 1, "ipd=2"},
      {"gscore", "", 1, "ipd=0.064"}};
  std::string points;
  for (const Case& c : cases) {
    Json set = Json::object();
    std::istringstream words(c.settings);
    for (std::string word; words >> word;) {
      const std::string value = word.substr(word.find('=') + 1);
      const bool is_json = Json::accept(value);
      set[word.substr(0, word.find('='))] = is_json ? Json::parse(value) : Json(value);
    }
    Json point = {{"config", c.config}, {"set", set}, {"view", c.view}};
    if (!c.stereo.empty()) point["stereo"] = c.stereo;
    points += point.dump() + "\n";
  }
  scratch.write("points", points);
  const std::string scene = "'builtin:object?n=1500' --size 96x54 ";
  require_done(shell(scratch, "$SG sweep " + scene + "--points points --out r.jsonl"));
  const std::vector<Json> results = results_in(scratch, "r.jsonl");
  REQUIRE(results.size() == cases.size());
  for (const Case& c : cases) {
    std::string line = "$SG simulate " + scene + "--out o --config " + c.config + " --view " +
                       std::to_string(c.view);
    if (!c.stereo.empty()) line += " --stereo " + c.stereo;
    std::istringstream words(c.settings);
    for (std::string word; words >> word;) line += " --set " + word;
    INFO(line);
    require_done(shell(scratch, line));
    const Json report =
        Json::parse(bytes_of(scratch.path("o/view_" + std::to_string(c.view) + "/report.json")));
    int found = 0;
    for (const Json& result : results) {
      const Json config = result.at("report").at("config");
      if (config != report["config"] || result["report"]["view"] != c.view) continue;
      ++found;
      CHECK(result["status"] == "done");
      CHECK(check_contained(without_time(result)["report"], report, "") > 200);
    }
    CHECK(found == 1);
  }
}

TEST_CASE("sweep: results of one eye and of two, near and far, are kept apart") {
  const ScratchFolder scratch;
  for (const char* stereo : {"", "--stereo ipd=0.1", "--stereo ipd=0.2"}) {
    for (const bool kept : {false, true}) {
      const ShellOutcome outcome = shell(scratch, std::string("$SG sweep $B --config gscore ") +
                                                      stereo + " --axis ccus=2 --out r.jsonl");
      require_done(outcome);
      CHECK((outcome.out.find("; 1 of them by an earlier sweep") != std::string::npos) == kept);
    }
  }
  std::vector<Json> said;
  for (const Json& result : results_in(scratch, "r.jsonl")) {
    said.push_back({result["point"].value("stereo", ""), result["report"]["config"]["eyes"]});
  }
  CHECK((said == std::vector<Json>{{"", 1}, {"ipd=0.1", 2}, {"ipd=0.2", 2}}));
  check_refused(
      scratch, "$SG sweep $B --stereo ipd=1 --config paper --axis hfus=2 --out q.jsonl",
      {"--stereo ipd=1 paper hfus=2: --stereo: got it with machine paper, which draws one"});
  check_refused(scratch, "$SG sweep $B --axis eyes=2 --out q.jsonl",
                {"eyes: got 2 without --stereo, expected 1"});
}

TEST_CASE("sweep: a packed scene is taken, and what does not go with it is refused") {
  const ScratchFolder scratch;
  require_done(shell(scratch,
                     "$SG pack $S --config exact_vq --out s.sgs; echo '[{\"id\": 0, \"img_name\": "
                     "\"v\", \"width\": 32, \"height\": 18, \"position\": [0, -1, -5], "
                     "\"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], \"fx\": 30, \"fy\": 30}]' "
                     ">c.json"));
  require_done(shell(scratch,
                     "$SG sweep s.sgs --config exact_vq --cameras c.json --axis hfus=2,4 --axis "
                     "storage.encoding=vq,raw --out r.jsonl --csv t.csv"));
  require_done(
      shell(scratch, "$SG simulate s.sgs --config exact_vq --cameras c.json --set hfus=2 --out o"));
  const Json report = Json::parse(bytes_of(scratch.path("o/view_0/report.json")));
  std::map<std::string, int> statuses;
  for (const Json& result : results_in(scratch, "r.jsonl")) {
    ++statuses[result["status"]];
    if (result["status"] == "refused") {
      CHECK(result["reason"].get<std::string>().find("s.sgs is stored so") != std::string::npos);
    } else if (result["point"]["set"]["hfus"] == 2) {
      check_contained(without_time(result)["report"], report, "");
    }
  }
  CHECK((statuses == std::map<std::string, int>{{"done", 2}, {"refused", 2}}));
  const std::string table = bytes_of(scratch.path("t.csv"));
  CHECK(std::count(table.begin(), table.end(), '\n') == 5);
  CHECK(table.rfind("scene,cameras,view,config,hfus,storage.encoding,", 0) == 0);
}

// A sweep that takes some seconds, and what tells how far it is.
const std::string kLong =
    "$SG sweep 'builtin:object?n=6000' --size 112x63 --axis hfus=1,2,3,4 --axis "
    "group_width_px=32,48,64 --set sram.input_bytes=0 --set sram.shared_bytes=0 ";
// Not to be waited for.
const std::string kEndless =
    "$SG sweep 'builtin:object?n=60000' --size 640x360 --axis hfus=1,2,3,4,5,6,7,8 --axis "
    "hfu.ffu_lanes=4,8,16,32 --axis sorting_units=1,2 --set sram.input_bytes=0 --set "
    "sram.shared_bytes=0 ";
const std::string kUntilTwo = "AWAIT '[ $(wc -l <r.jsonl 2>/dev/null || echo 0) -ge 2 ]'; ";

// A child that has just written its result ends as done, whatever kills it then, and there may be
// none between two.
const std::string kKillUntilOneFailed =
    "until grep -q 'by signal 9' r.jsonl || [ $(wc -l <r.jsonl) -ge 12 ]; do "
    "kill -9 $(cat /proc/$p/task/$p/children) 2>/dev/null; sleep 0.02; done; ";

void check_equal_to_serial_run(const ScratchFolder& scratch) {
  require_done(shell(scratch, kLong + "-j 1 --out serial.jsonl"));
  std::map<std::string, Json> serial;
  for (const Json& result : results_in(scratch, "serial.jsonl")) {
    serial[result["key"]] = without_time(result);
  }
  REQUIRE(serial.size() == 12);
  std::set<std::string> keys;
  for (const Json& result : results_in(scratch, "r.jsonl")) {
    if (result["status"] == "failed") continue;
    CHECK(keys.insert(result["key"]).second);
    CHECK(without_time(result) == serial.at(result["key"]));
  }
  CHECK(keys.size() == 12);
}

TEST_CASE("sweep: killed in the middle and continued it has each point once, as undisturbed") {
  const ScratchFolder scratch;
  require_done(shell(scratch, kLong + "-j 2 --out r.jsonl >/dev/null & p=$!; " + kUntilTwo +
                                  "kill -9 $p; wait $p; test $? = 137"));
  const std::size_t before = results_in(scratch, "r.jsonl").size();
  REQUIRE(before >= 2);
  REQUIRE(before < 12);
  // As if it had been killed while it wrote.
  require_done(shell(scratch, "head -c 300 r.jsonl | head -1 | head -c 200 >>r.jsonl"));
  const ShellOutcome again = shell(scratch, kLong + "-j 2 --out r.jsonl");
  require_done(again);
  INFO(again.out);
  CHECK(again.out.find("12 of 12 simulations: 12 done, 0 refused, 0 failed; " +
                       std::to_string(before) + " of them by an earlier sweep") !=
        std::string::npos);
  check_equal_to_serial_run(scratch);
}

TEST_CASE("sweep: children that are killed are failures with their point, and tried once more") {
  const ScratchFolder scratch;
  const ShellOutcome outcome = shell(
      scratch, kLong + "-j 2 --out r.jsonl & p=$!; " + kUntilTwo + kKillUntilOneFailed + "wait $p");
  require_done(outcome, 1);
  CHECK(outcome.out.find("ended by signal 9") != std::string::npos);
  int failed = 0;
  for (const Json& result : results_in(scratch, "r.jsonl")) {
    if (result["status"] != "failed") continue;
    ++failed;
    CHECK(result["attempts"] == 1);
    CHECK(result["point"]["set"].contains("hfus"));
  }
  CHECK(failed >= 1);
  require_done(shell(scratch, kLong + "--out r.jsonl"));
  check_equal_to_serial_run(scratch);
}

TEST_CASE("sweep: what failed twice is left alone") {
  const ScratchFolder scratch;
  const std::string line = "$SG sweep $B --axis hfus=2 --out ";
  require_done(shell(scratch, line + "r.jsonl"));
  Json failed = results_in(scratch, "r.jsonl").at(0);
  failed.erase("report");
  failed["status"] = "failed";
  failed["reason"] = "a bad day";
  for (const int attempts : {1, 2}) {
    failed["attempts"] = attempts;
    // The order of members is that of the program.
    scratch.write("f.jsonl",
                  "{\"key\":" + failed["key"].dump() + "," + failed.dump().substr(1) + "\n");
    const ShellOutcome outcome = shell(scratch, line + "f.jsonl");
    require_done(outcome, attempts == 1 ? 0 : 1);
    CHECK((outcome.out.find("a bad day") != std::string::npos) == (attempts == 2));
    CHECK(results_in(scratch, "f.jsonl").size() == (attempts == 1 ? 2 : 1));
  }
}

TEST_CASE("sweep: interrupted it keeps what is done, and leaves no child") {
  const ScratchFolder scratch;
  require_done(shell(
      scratch, kLong + "-j 2 --out r.jsonl --csv t.csv >/dev/null & p=$!; " + kUntilTwo +
                   "c=$(cat /proc/$p/task/$p/children); kill -INT $p; wait $p; test $? = 130 && "
                   "for one in $c; do ! kill -0 $one 2>/dev/null || exit 1; done"));
  const std::size_t done = results_in(scratch, "r.jsonl").size();
  CHECK(done >= 2);
  CHECK(done < 12);
  const std::string table = bytes_of(scratch.path("t.csv"));
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) == done + 1);
  require_done(shell(scratch, kLong + "--out r.jsonl"));
  check_equal_to_serial_run(scratch);
}

TEST_CASE("sweep: two of them do not write to one file") {
  const ScratchFolder scratch;
  const ShellOutcome outcome =
      shell(scratch, kEndless + "-j 1 --out r.jsonl >/dev/null & p=$!; " + kUntilTwo +
                         "$SG sweep $B --axis hfus=2 --out ./r.jsonl; echo second $?; kill $p; "
                         "wait $p; echo first $?");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.out == "second 2\nfirst 130\n");
  CHECK(outcome.err.find("another sweep is writing to it") != std::string::npos);
  for (const Json& result : results_in(scratch, "r.jsonl")) CHECK(result["status"] == "done");
}

TEST_CASE("sweep: points that come on standard input are answered one by one") {
  const ScratchFolder scratch;
  const ShellOutcome outcome = shell(
      scratch,
      "mkfifo in out; $SG sweep $B --points - --out r.jsonl <in >out & p=$!; exec 3>in 4<out\n"
      "ask() { echo \"$1\" >&3; read -r -t 30 answer <&4 || echo none; echo \"$answer\"; }\n"
      "ask '{\"id\": 7, \"set\": {\"hfus\": 2}}'\n"
      "ask '{\"id\": [\"a\"], \"set\": {\"hfus\": 2}}'\n"
      "ask '{\"id\": 8, \"set\": {\"nosuch\": 2}}'\n"
      "ask '{\"id\": 9, \"view\": 99}'\n"
      "ask 'hfus'\n"
      "ask '{\"id\": 10, \"scene\": \"builtin:object?n=200\", \"view\": 1, \"size\": \"16x16\"}'\n"
      "exec 3>&-; wait $p; echo $?");
  INFO(outcome.out << outcome.err);
  const std::vector<Json> answers = lines_of(outcome.out);
  REQUIRE(answers.size() == 7);
  CHECK(answers[0]["id"] == 7);
  CHECK(answers[0]["status"] == "done");
  CHECK(answers[0]["kept"] == false);
  CHECK(answers[1]["id"] == Json{"a"});
  CHECK(answers[1]["kept"] == true);
  CHECK(answers[1]["report"] == answers[0]["report"]);
  for (const int refused : {2, 3, 4}) CHECK(answers[refused]["status"] == "refused");
  CHECK(answers[2]["reason"].get<std::string>().find("nosuch") != std::string::npos);
  CHECK(answers[3]["reason"].get<std::string>().find("99") != std::string::npos);
  CHECK(answers[4]["reason"].get<std::string>().find("line 5") != std::string::npos);
  CHECK(answers[5]["report"]["frame"]["width_px"] == 16);
  CHECK(answers[5]["report"]["scene"]["gaussians"] == 200);
  CHECK(answers[6] == 0);
}

TEST_CASE("sweep: points without end are answered as they come, and Ctrl-C ends it") {
  // Who sends them, and what the first is answered.
  const std::pair<const char*, const char*> rows[] = {
      {"yes hfus=2", "\"status\":\"done\""},
      {"yes hfus=none", "\"status\":\"refused\""},
      {"cat /dev/zero", "standard input, line 1: got more than 1000000 B"}};
  for (const auto& [sender, answer] : rows) {
    INFO(sender);
    const ScratchFolder scratch;
    require_done(shell(scratch, "$SG sweep $B --points - --out r.jsonl < <(" + std::string(sender) +
                                    ") >out & p=$!; AWAIT '[ $(wc -l <out) -ge 1 ]'; "
                                    "kill -INT $p; wait $p"),
                 130);
    const std::string out = bytes_of(scratch.path("out"));
    CHECK(out.substr(0, out.find('\n')).find(answer) != std::string::npos);
  }
}

TEST_CASE("sweep: what is in a file of another kind stays there") {
  for (const char* text : {"{\"a\": 1}\n", "notes", "{\"key\":\"a\",\"status\":3}\n", "\n"}) {
    const ScratchFolder scratch;
    scratch.write("r", text);
    check_refused(scratch, "$SG sweep $B --axis hfus=2 --out r", {"r:1: got no result of a sweep"});
    CHECK(bytes_of(scratch.path("r")) == text);
  }
}

TEST_CASE("sweep: a result file that cannot grow is an error, and whole lines stay in it") {
  const ScratchFolder scratch;
  require_done(shell(scratch, "$SG sweep $B --axis hfus=3 --out r.jsonl"));
  const std::string before = bytes_of(scratch.path("r.jsonl"));
  const ShellOutcome outcome =
      shell(scratch, "(ulimit -f 16; $SG sweep $B --axis hfus=1,2,4 --out r.jsonl)");
  require_done(outcome, 1);
  CHECK(outcome.err.find("r.jsonl: cannot be written") != std::string::npos);
  const std::string after = bytes_of(scratch.path("r.jsonl"));
  CHECK(after.rfind(before, 0) == 0);
  CHECK(after.back() == '\n');
  require_done(shell(scratch, "$SG sweep $B --axis hfus=1,2,3,4 --out r.jsonl"));
  CHECK(results_in(scratch, "r.jsonl").size() == 4);
}

TEST_CASE("sweep: what was simulated of another file of the same name counts no more") {
  const ScratchFolder scratch;
  require_done(
      shell(scratch,
            "mkdir bin; cp $SG $SG-commands bin; cp -rL ${SG%/*}/../share .\n"
            "$SG pack $S --out s.ply; echo '[{\"id\": 0, \"img_name\": \"v\", \"width\": 32, "
            "\"height\": 18, \"position\": [0, -1, -5], \"rotation\": [[1, 0, 0], [0, 1, 0], "
            "[0, 0, 1]], \"fx\": 30, \"fy\": 30}]' >c.json"));
  std::set<Json> keys;
  for (const char* change :
       {"true", "echo >>share/streaminggs/memspecs/lpddr3_1600_4gb.json",
        "echo >>share/streaminggs/technology_32nm.json", "sed -i s/-5/-6/ c.json",
        "$SG pack 'builtin:object?n=301' --out s.ply",
        R"(sed -i 's/"entries": 768/"entries": 256/' share/streaminggs/presets/exact.json)"}) {
    INFO(change);
    const std::string sweep =
        "bin/streaminggs sweep s.ply --cameras c.json --axis hfus=2 --out r.jsonl; ";
    require_done(shell(scratch, change + ("; " + sweep + sweep)));
    const std::vector<Json> results = results_in(scratch, "r.jsonl");
    CHECK(keys.insert(results.back()["key"]).second);
    CHECK(results.size() == keys.size());
  }
}

}  // namespace
}  // namespace sgs::test
