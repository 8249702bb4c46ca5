// Configurations that say next to nothing, and runs of which one view fails.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
using Json = nlohmann::json;

TEST_CASE("configuration: what a file leaves out has defaults that fit each other") {
  for (const char* text : {"{}", R"({"hfus": 4})", R"({"machine": "exact"})",
                           R"({"machine": "paper"})", R"({"machine": "paper", "hfus": 4})"}) {
    INFO(text);
    const ScratchFolder scratch;
    const Simulation simulation({"builtin:object?n=1000", "--size", "64x36", "--config",
                                 scratch.write("config.json", text)});
    simulation.check();
    const std::string machine = simulation.views()[0]["config"]["machine"];
    const bool paper = std::string(text).find("paper") != std::string::npos;
    CHECK(machine == (paper ? "paper" : "exact"));
    CHECK(simulation.views()[0]["config"]["hfus"] == 4);
  }
}

// Views of which some need a larger ordering table than there is, and how large each one's is.
struct TableNeeds {
  Arguments arguments = {
      "builtin:object?n=3000", "--size", "64x36", "--view", "all", "--config", "paper_no_vq"};
  std::vector<std::uint64_t> bytes;  // [view]
  std::uint64_t enough_for_some = 0;
  TableNeeds() {
    const Simulation simulation(arguments);
    for (const Json& view : simulation.views()) {
      bytes.push_back(counter(view, "vsu", "ordering_table_bytes_max"));
    }
    enough_for_some = *std::max_element(bytes.begin(), bytes.end()) - 1;
  }
};

TEST_CASE("configuration: a view that fails is named, loses no other, and ends with status 1") {
  const TableNeeds needs;
  const ScratchFolder scratch;
  const Outcome outcome =
      run_streaminggs(joined(joined({"simulate"}, needs.arguments),
                             {"--set", "vsu.table_bytes=" + std::to_string(needs.enough_for_some),
                              "--out", scratch.path("out")}));
  CHECK(outcome.status == 1);
  const Json report = Json::parse(bytes_of(scratch.path("out/report.json")));
  std::size_t finished = 0, failed = 0;
  for (std::size_t view = 0; view < needs.bytes.size(); ++view) {
    INFO("view " << view);
    const std::string folder = scratch.path("out/view_" + std::to_string(view));
    if (needs.bytes[view] > needs.enough_for_some) {
      CHECK_THAT(outcome.err, Contains("streaminggs: view " + std::to_string(view) + ": "));
      CHECK(report["failed"][failed++]["view"] == view);
      CHECK_FALSE(std::filesystem::exists(folder));
    } else {
      CHECK(report["views"][finished++]["view"] == view);
      CHECK(std::filesystem::exists(folder + "/report.json"));
      CHECK(std::filesystem::exists(folder + "/frame.png"));
    }
  }
  CHECK_THAT(outcome.err, Contains("vsu.table_bytes is"));
  CHECK(report["views"].size() == finished);
  CHECK(report["failed"].size() == failed);
  REQUIRE(finished > 0);
  REQUIRE(failed > 0);
  for (Json view : report["views"]) {
    view["config"] = report["config"];
    check_any_machine(view);
  }
}

TEST_CASE("configuration: where every view fails nothing is written") {
  const TableNeeds needs;
  for (const char* view : {"all", "0"}) {
    INFO(view);
    const ScratchFolder scratch;
    Arguments arguments = needs.arguments;
    arguments[4] = view;
    const Outcome outcome =
        run_streaminggs(joined(joined({"simulate"}, arguments),
                               {"--set", "vsu.table_bytes=8", "--out", scratch.path("out")}));
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Contains("vsu.table_bytes is 8"));
    CHECK(scratch.file_count() == 0);
  }
}

TEST_CASE("configuration: views that all finish leave nobody named as failed") {
  const ScratchFolder scratch;
  REQUIRE(run_streaminggs({"simulate", "builtin:object?n=500", "--size", "32x18", "--view", "all",
                           "--out", scratch.path("out")})
              .status == 0);
  CHECK(Json::parse(bytes_of(scratch.path("out/report.json")))["failed"].empty());
}

}  // namespace
}  // namespace sgs::test
