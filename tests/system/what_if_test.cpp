// What what-if says of a doubled resource is what simulate says of a machine that has it.
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>
#include <string>

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

void check_rows(const std::string& preset, const Arguments& drawn) {
  const ScratchFolder scratch;
  const std::string table = scratch.path("what_if.json");
  const Arguments scene = joined(drawn, {"--config", preset});
  const Outcome done = run_streaminggs(
      with_settings(joined({"what-if"}, joined(scene, {"--out", table})), {"framebuffer=rgb32f"}));
  INFO(done.err);
  REQUIRE(done.status == 0);
  const json view = json::parse(std::ifstream(table)).at(0);
  int rows = 0;
  for (const json& row : view["doubled"]) {
    const auto key = row["key"].get<std::string>();
    if (row.contains("refused")) continue;
    std::ostringstream to;
    to << row["to"].get<double>();
    INFO(preset << ": " << key);
    const Simulation alone(
        with_settings(scene, {key + "=" + to.str(), "sram.shared_bytes=0", "sram.input_bytes=0"}));
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
