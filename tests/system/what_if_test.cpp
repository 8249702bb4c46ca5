// What what-if says is what simulate says: of the machine as it is, and of one with a doubled
// resource.
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "testbench/cost/technology.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using nlohmann::json;

// PHY and controller of each channel more are on the die, beside what the machine has more.
void check_channels_cost(const json& base, const json& row) {
  const auto more = [&](const char* key) {
    return row[key].get<double>() - base[key].get<double>();
  };
  const double mm2 = load_technology(SGS_TECHNOLOGY).memory_interface.mm2.middle;
  const double channels = row["to"].get<double>() - row["from"].get<double>();
  CHECK(more("area_with_memory_interface_mm2") > more("area_mm2") + channels * mm2);
}

// The answer for a single view.
json what_if(const Arguments& drawn) {
  const ScratchFolder scratch;
  const std::string table = scratch.path("what_if.json");
  const Outcome done = run_streaminggs(
      with_settings(joined({"what-if"}, joined(drawn, {"--out", table})), {"framebuffer=rgb32f"}));
  INFO(done.err);
  REQUIRE(done.status == 0);
  return json::parse(std::ifstream(table)).at(0);
}

void check_base(const Arguments& drawn) {
  const json base = what_if(drawn)["base"], simulated = Simulation(drawn).views()[0];
  CHECK(base["cycles"] == simulated["frame"]["cycles"]);
  CHECK(base["bus_bytes"] == simulated["dram"]["bus_bytes"]);
  CHECK(base["energy_j"] == simulated["energy"]["total_j"]);
  CHECK(base["area_mm2"] == simulated["area_mm2"]["total"]);
}

void check_rows(const std::string& preset, const Arguments& drawn) {
  const Arguments scene = joined(drawn, {"--config", preset});
  const json view = what_if(scene);
  int rows = 0;
  for (const json& row : view["doubled"]) {
    const auto key = row["key"].get<std::string>();
    if (row.contains("refused")) continue;
    std::ostringstream to;
    to << row["to"].get<double>();
    INFO(preset << ": " << key);
    const Simulation alone(
        with_settings(joined(scene, {"--fit-memories"}), {key + "=" + to.str()}));
    CHECK(alone.views()[0]["frame"]["cycles"] == row["cycles"]);
    const json& area = alone.views()[0]["area_mm2"];
    CHECK(area["total"].get<double>() == Approx(row["area_mm2"].get<double>()));
    CHECK(area["with_memory_interface"]["middle"].get<double>() ==
          Approx(row["area_with_memory_interface_mm2"].get<double>()));
    if (key == "dram.channels") check_channels_cost(view["base"], row);
    ++rows;
  }
  CHECK(rows > 5);
}

const Arguments kSmall = {"builtin:object?n=20", "--size", "32x18"};

void check_presets(const std::vector<std::string>& presets) {
  for (const std::string& preset : presets) {
    INFO(preset);
    check_base(joined(kSmall, {"--config", preset}));
  }
}

TEST_CASE("what-if: it begins from the machine that simulate runs, of each kind") {
  check_presets({"exact_fast", "paper_no_vq", "gscore", "gscore_lossless"});
  check_base(with_settings(kSmall, {"group_width_px=0", "group_height_px=0"}));
  check_base(with_settings(joined(kSmall, {"--fit-memories"}), {"hfus=8"}));
}

TEST_CASE("what-if: it begins from the machine that simulate runs, of two eyes") {
  const Arguments pair = joined(kSmall, {"--stereo", "ipd=0.1", "--fit-memories"});
  for (const char* preset : {"exact", "gscore"}) check_base(joined(pair, {"--config", preset}));
}

TEST_CASE("what-if: it begins from the machine that simulate runs, other presets", "[nightly]") {
  check_presets({"exact", "exact_fp16", "exact_half", "exact_vq", "exact_vq_packed", "exact_wide",
                 "gscore_fp32_keys", "paper", "paper_no_cgf", "paper_no_vq_cgf"});
}

TEST_CASE("what-if: a row is the frame of a machine with that much of it, few Gaussians") {
  check_rows("paper_no_vq", {"builtin:object?n=50", "--size", "32x18"});
}

TEST_CASE("what-if: a row is the frame of a machine with that much of it, depths and all",
          "[nightly]") {
  for (const char* preset : {"exact", "paper_no_vq"}) {
    check_rows(preset, {"builtin:object?n=2000", "--size", "96x54"});
  }
}

}  // namespace
}  // namespace sgs::test
