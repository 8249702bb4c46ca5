// What diff makes of two reports: pairs, weights, and what it refuses.
#include "testbench/streaminggs/report/report_diff.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using nlohmann::json;

json wait(const char* what, const char* on, int cycles) {
  return {{"for", what}, {"on", on}, {"cycles", cycles}};
}

// A frame of 1,000 cycles by two filters and a reader.
json view_of(int number) {
  const auto activity = [](int busy, const json& waits) {
    return json{{"busy_cycles", busy}, {"waits", waits}};
  };
  const json idle = {{"for", "idle"}, {"cycles", 100}};
  return {{"schema_version", 2},
          {"view", number},
          {"scene", {{"name", "s"}, {"gaussians", 5}, {"sh_degree", 3}, {"dropped_invalid", 0}}},
          {"camera", {{"id", 7}, {"img_name", "front"}}},
          {"frame", {{"cycles", 1000}, {"time_s", 1e-6}, {"width_px", 64}, {"height_px", 36}}},
          {"image", {{"psnr_db", nullptr}, {"equals_streaming_renderer", true}}},
          {"binding", {{"holds", "dram"}}},
          {"units",
           {{"hfu0",
             {{"activities",
               {{"filter", activity(500, json::array({wait("input", "to_hfu0", 400), idle}))},
                {"load", activity(10, json::array())}}}}},
            {"hfu1",
             {{"activities",
               {{"filter", activity(300, json::array({wait("input", "to_hfu1", 700)}))}}}}}}},
          {"dram",
           {{"bytes", 4000},
            {"bytes_by_region",
             {{"first", {{"hfu0", {{"read", 1500}}}, {"hfu1", {{"read", 2500}}}}}}}}},
          {"energy",
           {{"fine_j", 3.0},
            {"total_j", 4.0},
            {"dram_j", 1.0},
            {"mean_power_w", 9.0},
            {"bands", {{"fine_j", {}}, {"dram_j", {}}, {"total_j", {}}}}}},
          {"area_mm2", {{"fine", 2.0}, {"total", 2.0}, {"bands", {{"fine", {}}, {"total", {}}}}}},
          {"provenance",
           {{"technology", "32 nm"}, {"technology_xxh64", "0"}, {"version", "1"}, {"commit", "c"}}},
          {"chosen", json::array({{{"key", "hfus"}, {"value", 2}}})},
          {"config", {{"hfus", 2}, {"dram", {{"channels", 4}}}}}};
}

json run_of(const std::vector<json>& views) {
  return {{"schema_version", 2}, {"config", views[0]["config"]}, {"views", views}};
}

ReportedRun read(const ScratchFolder& scratch, const char* name, const json& report) {
  return read_reported_run(scratch.write(name, report.dump()));
}

const QuantityChange& of(const ReportDiff& diff, Quantity quantity) {
  for (const QuantityChange& q : diff.quantities) {
    if (q.quantity == quantity) return q;
  }
  throw std::logic_error("no such quantity");
}

TEST_CASE("diff: a report and itself, of all views, of one, by its folder") {
  const ScratchFolder scratch;
  const ReportedRun all = read(scratch, "report.json", run_of({view_of(0)}));
  for (const ReportedRun& same :
       {all, read(scratch, "one.json", view_of(0)), read_reported_run(scratch.path("."))}) {
    const ReportDiff diff = diff_runs(all, same);
    CHECK(diff.unlike.empty());
    CHECK(diff.config.empty());
    CHECK(diff.equal_keys == 2);
    for (const QuantityChange& q : diff.quantities) CHECK((q.parts.empty() && q.a == q.b));
    CHECK(of(diff, Quantity::kBusy).equal == 2);  // filters of both HFUs are one part
    CHECK(of(diff, Quantity::kWaits).equal == 1);
    CHECK(of(diff, Quantity::kBytes).equal == 1);
  }
}

TEST_CASE("diff: the frames of a camera path are views") {
  const ScratchFolder scratch;
  json path = run_of({view_of(0), view_of(1)});
  path["path"] = {{"name", "walk"}};
  path["summary"] = {{"frames", 2}};
  CHECK(read(scratch, "report.json", path).views.size() == 2);
}

TEST_CASE("diff: frames back to back are one view, compared with their like alone") {
  const ScratchFolder scratch;
  const auto stream_of = [&](const char* name, const json& worst_db, double rate) {
    json all = view_of(0);
    for (const char* key : {"view", "camera", "image", "config"}) all.erase(key);
    const json frame = {{"psnr_db", nullptr}, {"equals_streaming_renderer", true}};
    json worst = frame;
    worst["psnr_db"] = worst_db;
    return read(
        scratch, name,
        {{"schema_version", 2},
         {"config", view_of(0)["config"]},
         {"path", {{"name", "walk"}}},
         {"stream", {{"frame_rate", rate}, {"frames", {frame, worst, frame}}, {"all", all}}},
         {"views", json::array()}});
  };
  const ReportedRun one = stream_of("one.json", 50.5, 90), equal = stream_of("b.json", nullptr, 90),
                    fast = stream_of("c.json", 50.5, 120);
  CHECK(one.views.at(0).psnr_db == "50.50");
  CHECK(equal.views.at(0).psnr_db == "equal");
  const ReportDiff same = diff_runs(one, equal);
  CHECK(same.streams);
  CHECK(same.unlike.empty());
  CHECK(of(same, Quantity::kBusy).a == 1000);
  CHECK(diff_runs(one, fast).unlike == std::vector<std::string>{"pictures a second: 90.0 | 120.0"});
  const ReportedRun views = read(scratch, "views.json", run_of({view_of(0)}));
  const std::string error = input_error_of([&] { diff_runs(views, one); });
  CHECK(error.find("frames back to back in the second alone, expected both of simulate --stream") !=
        std::string::npos);
}

TEST_CASE("diff: one value changed, by table") {
  struct Row {
    const char* pointer;
    json value;
    Quantity quantity;
    const char* part;
    double a, b, of_whole;
  };
  for (const Row& row :
       std::vector<Row>{// Of two copies the mean; against the frame of 1,000 cycles.
                        {"/units/hfu0/activities/filter/busy_cycles", 700, Quantity::kBusy,
                         "hfuN.filter", 400, 500, 0.1},
                        {"/units/hfu1/activities/filter/waits/0/cycles", 500, Quantity::kWaits,
                         "hfuN.filter: input at to_hfuN", 550, 450, -0.1},
                        {"/dram/bytes_by_region/first/hfu0/read", 500, Quantity::kBytes,
                         "first: hfuN read", 4000, 3000, -0.25},
                        {"/energy/fine_j", 5.0, Quantity::kJoules, "fine", 3, 5, 0.5},
                        {"/area_mm2/fine", 1.0, Quantity::kArea, "fine", 2, 1, -0.5}}) {
    INFO(row.pointer);
    const ScratchFolder scratch;
    json changed = view_of(0);
    changed[json::json_pointer(row.pointer)] = row.value;
    const ReportedRun a = read(scratch, "a.json", view_of(0));
    const ReportedRun b = read(scratch, "b.json", changed);
    const ReportDiff diff = diff_runs(a, b);
    for (const QuantityChange& q : diff.quantities) {
      CHECK(q.parts.size() == (q.quantity == row.quantity ? 1 : 0));
    }
    const PartChange& part = of(diff, row.quantity).parts.at(0);
    CHECK(part.name == row.part);
    CHECK(part.a == Approx(row.a));
    CHECK(part.b == Approx(row.b));
    CHECK(part.of_whole == Approx(row.of_whole));
  }
}

TEST_CASE("diff: area by owner, the memory's interface included, where both reports tell it") {
  const ScratchFolder scratch;
  const auto with_channels = [](double channels) {
    json view = view_of(0);
    view["area_mm2"]["with_memory_interface"] = {{"middle", 2 + channels}};
    view["area_mm2"]["by_owner"] = {{"hfu", 2.0}, {"memory_interface", channels}};
    return view;
  };
  const ReportedRun earlier = read(scratch, "earlier.json", view_of(0));
  const ReportedRun a = read(scratch, "a.json", with_channels(4));
  const ReportedRun b = read(scratch, "b.json", with_channels(8));
  const ReportDiff diff = diff_runs(a, b);
  const QuantityChange& die = of(diff, Quantity::kDieArea);
  CHECK((die.a == 6 && die.b == 10));
  REQUIRE(die.parts.size() == 1);
  CHECK(die.parts[0].name == "memory_interface");
  CHECK(die.parts[0].of_whole == Approx(4.0 / 6));
  for (const QuantityChange& q : diff_runs(earlier, b).quantities) {
    CHECK(q.quantity != Quantity::kDieArea);
  }
}

TEST_CASE("diff: joules without the memory's are compared with their like alone") {
  const ScratchFolder scratch;
  json without = view_of(0);
  without["energy"] = {{"fine_j", 3.0},
                       {"total_j", 3.0},
                       {"mean_power_w", 7.0},
                       {"memory_known", false},
                       {"bands", {{"fine_j", {}}, {"total_j", {}}}}};
  const ReportedRun a = read(scratch, "a.json", view_of(0));
  const ReportedRun b = read(scratch, "b.json", without);
  const ReportDiff unlike = diff_runs(a, b), alike = diff_runs(b, b);
  CHECK(unlike.unlike ==
        std::vector<std::string>{
            "energy: with the memory's | without the memory's, which is not known"});
  CHECK_FALSE(unlike.without_memory);
  for (const QuantityChange& q : unlike.quantities) CHECK(q.quantity != Quantity::kJoules);
  CHECK(alike.unlike.empty());
  CHECK(alike.without_memory);
  CHECK(of(alike, Quantity::kJoules).a == 3);
}

TEST_CASE("diff: a memory that is not used whole says what of it is") {
  const ScratchFolder scratch;
  const auto with_memory = [](int bytes) {
    json view = view_of(0);
    view["config"]["sram"] = {{"input_bytes", bytes}};
    view["sram"] = {{"input_bytes", 700}, {"input_available_bytes", bytes}};
    return view;
  };
  const ReportedRun a = read(scratch, "a.json", with_memory(900));
  const ReportedRun b = read(scratch, "b.json", with_memory(700));
  const ReportDiff diff = diff_runs(a, b);
  REQUIRE(diff.config.size() == 1);
  CHECK(diff.config[0].a == "900 (700 used)");
  CHECK(diff.config[0].b == "700");
}

TEST_CASE("diff: by weight, quantities and parts, and units that only one run has") {
  const ScratchFolder scratch;
  json changed = view_of(0);
  changed["frame"]["cycles"] = 500;
  changed["area_mm2"]["total"] = 2.2;
  changed["units"]["hfu0"]["activities"]["load"]["busy_cycles"] = 20;
  changed["units"].erase("hfu1");
  changed["units"]["merge"]["activities"]["merge"] = {{"busy_cycles", 50},
                                                      {"waits", json::array()}};
  const ReportedRun a = read(scratch, "a.json", view_of(0));
  const ReportedRun b = read(scratch, "b.json", changed);
  const ReportDiff diff = diff_runs(a, b);
  CHECK(diff.quantities[0].quantity == Quantity::kTime);
  CHECK(diff.quantities[1].quantity == Quantity::kWaits);  // 1,100 of three to 400 of three
  CHECK(diff.quantities[2].quantity == Quantity::kBusy);
  CHECK(diff.quantities[2].ratio() == Approx(-0.5));
  CHECK(diff.quantities[3].quantity == Quantity::kArea);
  const auto& parts = diff.quantities[2].parts;
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].name == "hfuN.filter");  // 400 of two to 500 of one
  CHECK((parts[0].copies_a == 2 && parts[0].copies_b == 1));
  CHECK(parts[1].name == "merge.merge");
  CHECK((parts[1].a == 0 && parts[1].copies_a == 0));
  CHECK(parts[2].name == "hfuN.load");
}

TEST_CASE("diff: runs of two clocks are compared by time") {
  const ScratchFolder scratch;
  const auto at_clock = [](int mhz, int cycles) {
    json view = view_of(0);
    view["config"]["clock_mhz"] = mhz;
    view["frame"]["cycles"] = cycles;
    view["frame"]["time_s"] = cycles / (1e6 * mhz);
    return view;
  };
  const ReportedRun a = read(scratch, "a.json", at_clock(1000, 1000));
  const ReportedRun b = read(scratch, "b.json", at_clock(2000, 1500));
  const ReportDiff diff = diff_runs(a, b);
  CHECK(diff.clocks_differ);
  CHECK(diff.quantities[0].quantity == Quantity::kTime);
  CHECK(diff.quantities[0].ratio() == Approx(-0.25));
  CHECK(of(diff, Quantity::kBusy).ratio() == Approx(0.5));
  CHECK_FALSE(diff_runs(a, a).clocks_differ);
}

TEST_CASE("diff: scenes of one name are told by their bytes, where both store alike") {
  struct Row {
    const char *hash, *encoding;
    std::size_t unlike;
  };
  const auto stored = [](const char* hash, const char* encoding) {
    json view = view_of(0);
    view["provenance"]["memory_image_xxh64"] = hash;
    view["config"]["storage"] = {{"encoding", encoding}};
    return view;
  };
  for (const Row& row : std::vector<Row>{{"1", "raw", 0}, {"2", "raw", 1}, {"2", "half", 0}}) {
    INFO(row.hash << " " << row.encoding);
    const ScratchFolder scratch;
    const ReportedRun a = read(scratch, "a.json", stored("1", "raw"));
    const ReportedRun b = read(scratch, "b.json", stored(row.hash, row.encoding));
    const std::vector<std::string> unlike = diff_runs(a, b).unlike;
    REQUIRE(unlike.size() == row.unlike);
    if (row.unlike > 0) CHECK(unlike[0] == "scene's bytes in DRAM, their hash: 1 | 2");
    const ReportedRun earlier = read(scratch, "earlier.json", view_of(0));
    CHECK(diff_runs(earlier, b).unlike.empty());
  }
}

TEST_CASE("diff: the mean of the views that both have") {
  const ScratchFolder scratch;
  json second = view_of(2);
  second["frame"]["cycles"] = 3000;
  const ReportedRun a = read(scratch, "a.json", run_of({second, view_of(0)}));
  const ReportedRun b = read(scratch, "b.json", run_of({view_of(0), view_of(1), view_of(2)}));
  const ReportDiff diff = diff_runs(a, b);
  REQUIRE(diff.views.size() == 2);
  CHECK(diff.unlike == std::vector<std::string>{"views of B alone: 1"});
  CHECK(of(diff, Quantity::kBusy).a == 2000);
  CHECK(of(diff, Quantity::kBusy).b == 1000);
  const ReportedRun c = read(scratch, "c.json", run_of({view_of(5)}));
  CHECK(input_error_of([&] { diff_runs(a, c); }).find("expected one or more") != std::string::npos);
}

TEST_CASE("diff: what is not of the same is said, by table") {
  struct Row {
    const char* pointer;
    json value;
    const char* says;
  };
  for (const Row& row : std::vector<Row>{
           {"/scene/gaussians", 6, "scene: s, 5 Gaussians, SH degree 3, 0 dropped | s, 6 Gaus"},
           {"/camera/img_name", "side", "camera: 7 (front) | 7 (side)"},
           {"/frame/width_px", 65, "size, px: 64x36 | 65x36"},
           {"/provenance/technology", "22 nm", "technology: 32 nm | 22 nm"},
           {"/provenance/technology_xxh64", "1", "technology's hash: 0 | 1"},
           {"/provenance/commit", "d", "program: 1 c | 1 d"}}) {
    const ScratchFolder scratch;
    json changed = view_of(0);
    changed[json::json_pointer(row.pointer)] = row.value;
    const ReportedRun a = read(scratch, "a.json", run_of({view_of(0), view_of(1)}));
    const ReportedRun b = read(scratch, "b.json", run_of({changed, view_of(1)}));
    const ReportDiff diff = diff_runs(a, b);
    REQUIRE(diff.unlike.size() == 1);
    INFO(diff.unlike[0]);
    CHECK(diff.unlike[0].find(std::string("view 0: ") + row.says) == 0);
  }
  // The camera's pose, where both reports have it.
  const ScratchFolder scratch;
  const auto standing = [](double x) {
    json view = view_of(0);
    const json pose = {
        {"position", {x, 0, 0}}, {"rotation", json::array()}, {"fx_px", 9}, {"fy_px", 9}};
    view["camera"].update(pose);
    return view;
  };
  const ReportedRun old = read(scratch, "old.json", view_of(0));
  const ReportedRun here = read(scratch, "here.json", standing(1));
  const ReportedRun there = read(scratch, "there.json", standing(2));
  CHECK(diff_runs(here, there).unlike ==
        std::vector<std::string>{"camera stands at: 1 0 0 | 2 0 0"});
  CHECK(diff_runs(old, here).unlike.empty());
  json other_name = standing(1 + 1e-12);  // another file may tell the same pose so
  other_name["camera"]["img_name"] = "frame_00000";
  const ReportedRun renamed = read(scratch, "renamed.json", other_name);
  CHECK(diff_runs(here, renamed).unlike.empty());
  CHECK(diff_runs(here, old).unlike.empty());
}

TEST_CASE("diff: keys of the configuration") {
  const ScratchFolder scratch;
  json changed = view_of(0);
  changed["config"] = {{"hfus", 8}, {"merge", {{"entries", 512}}}};
  changed["chosen"] = json::array();
  const ReportedRun a = read(scratch, "a.json", view_of(0));
  const ReportedRun b = read(scratch, "b.json", changed);
  const ReportDiff diff = diff_runs(a, b);
  REQUIRE(diff.config.size() == 1);
  CHECK(diff.equal_keys == 0);
  CHECK(diff.config[0].key == "hfus");
  CHECK((diff.config[0].a == "2 (chosen)" && diff.config[0].b == "8"));
  CHECK(diff.keys_of_a == std::vector<std::string>{"dram.channels"});
  CHECK(diff.keys_of_b == std::vector<std::string>{"merge.entries"});
}

TEST_CASE("diff: no report, by table") {
  struct Row {
    const char* pointer;
    json value;
    std::vector<std::string> words;
  };
  const json nothing(json::value_t::discarded);
  for (const Row& row : std::vector<Row>{
           {"", json::array({1}), {".json: got [1], expected an object"}},
           {"/schema_version", 1, {"schema_version: got 1, expected 2"}},
           {"/schema_version", nothing, {"schema_version: got nothing"}},
           {"/views", 3, {"views: got 3, expected a list"}},
           {"/views", json::array(), {"views: got [], expected a finished view or more"}},
           {"/config", "x", {"config: got \"x\", expected an object"}},
           {"/views/0/frame/cycles",
            "many",
            {"views[0].frame.cycles: got \"many\", expected a finite nu"}},
           {"/views/0/frame", nothing, {"views[0].frame: got nothing"}},
           {"/views/0/units/hfu0/activities/filter/waits/0/for",
            1,
            {"views[0].units.hfu0.activities.filter.waits[0].for: got 1, expected a text"}},
           {"/views/0/dram/bytes_by_region/first/hfu0", 1, {"first.hfu0: got 1, expected an obj"}},
           {"/views/0/energy/dram_j", nothing, {"views[0].energy.dram_j: got nothing"}},
           {"/views/0/image/psnr_db", "high", {"views[0].image.psnr_db: got \"high\""}}}) {
    INFO(row.pointer);
    const ScratchFolder scratch;
    json report = run_of({view_of(0)});
    const json::json_pointer at(row.pointer);
    if (row.value.is_discarded()) {
      report[at.parent_pointer()].erase(at.back());
    } else {
      report[at] = row.value;
    }
    const std::string error = input_error_of([&] { read(scratch, "bad.json", report); });
    INFO(error);
    CHECK(error.find(scratch.path("bad.json") + ": ") == 0);
    for (const std::string& word : row.words) CHECK(error.find(word) != std::string::npos);
  }
}

}  // namespace
}  // namespace sgs::test
