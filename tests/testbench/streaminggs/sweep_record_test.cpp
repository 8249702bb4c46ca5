// sweep_record.h: what a result says of its point, to people.
#include "testbench/streaminggs/sweep/sweep_record.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace sgs {
namespace {

TEST_CASE("sweep record: in short it says which point, and why it has no report") {
  const std::vector<std::pair<PointInWords, std::string>> cases = {
      {{"truck.ply", "", "", "", "", "exact", {}}, "truck.ply exact"},
      {{"truck.ply", "truck.json", "3", "64x48", "ipd=1", "paper", {"hfus=2", "dram.memspec=ddr"}},
       "truck.ply view 3 64x48 --stereo ipd=1 paper hfus=2 dram.memspec=ddr"}};
  for (const auto& [point, said] : cases) {
    CHECK(in_short(line_of_refused("k", point, "too few")) == said + ": too few");
    CHECK(in_short(line_of_failed("k", point, "killed", 2)) == said + ": killed");
  }
}

TEST_CASE("sweep record: of the bands of area that of the whole is kept") {
  using Json = nlohmann::ordered_json;
  const Json band = {{"low", 3}, {"high", 6}};
  Json report = {{"area_mm2", {{"total", 4}, {"bands", {{"vsu", band}, {"total", band}}}}},
                 {"energy", {{"total_j", 1}, {"bands", {{"total", band}}}}},
                 {"host", {{"simulation_wall_s", 1}}}};
  report["units"] = Json::object();
  const Json kept = Json::parse(line_of_done("k", {}, report))["report"];
  CHECK(kept["area_mm2"] == Json{{"total", 4}, {"bands", {{"total", band}}}});
  CHECK(kept["energy"] == Json{{"total_j", 1}});
}

}  // namespace
}  // namespace sgs
